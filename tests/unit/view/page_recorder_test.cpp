#include "host/view/page_recorder.hpp"

#include <gtest/gtest.h>

#include "host/log_reader.hpp"
#include "host/view/recordings.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;

struct Recorder {
  test::TestFolder folder;
  Access access{"0123456789abcdef", true};
  Picture picture;
  PageRecorder recorder{access, folder.path(), picture};

  json ask(const std::string& word, const std::string& name = "", const std::string& notes = "") {
    return recorder.request({{"record", word}, {"name", name}, {"notes", notes}, {"id", 4}, {"token", access.token}});
  }
  void hear() {
    const auto bytes = test::encoded(test::batch_of(1, 0, 20));
    recorder.take({1'000'000, kTicksChannel, bytes});
  }
};

TEST(PageRecorder, WritesWhatItHearsBetweenStartAndStop) {
  Recorder r;
  r.hear();
  EXPECT_EQ(r.ask("start", "knot-1", "first try")["accepted"], true);
  r.hear();
  r.hear();
  EXPECT_EQ(r.ask("stop")["accepted"], true);
  r.hear();
  LogReader log(r.folder.file("knot-1.lcmlog"));
  std::vector<std::string> channels;
  while (const auto* event = log.next()) channels.emplace_back(event->channel);
  EXPECT_EQ(channels, (std::vector<std::string>{std::string(PageRecorder::kNotesChannel), std::string(kTicksChannel),
                                                std::string(kTicksChannel)}));
}

TEST(PageRecorder, ListsTheRecordingsOfItsFolder) {
  Recorder r;
  EXPECT_EQ(r.ask("list")["files"], json::array());
  (void)r.ask("start", "knot-1");
  r.hear();
  (void)r.ask("stop");
  test::write_text(r.folder.file("notes.txt"), "no recording");
  test::write_text(r.folder.file(".hidden.lcmlog"), "not named by a page");
  const json listed = r.ask("list");
  EXPECT_EQ(listed["accepted"], true);
  ASSERT_EQ(listed["files"].size(), 1U) << listed;
  EXPECT_EQ(listed["files"][0]["name"], "knot-1.lcmlog");
  EXPECT_EQ(listed["files"][0]["bytes"], std::filesystem::file_size(r.folder.file("knot-1.lcmlog")));
  EXPECT_GT(listed["files"][0]["modified_s"], 1.6e9);
  EXPECT_EQ(r.recorder.request({{"record", "list"}, {"token", "wrong"}})["accepted"], false);
}

TEST(PageRecorder, NamesHaveLettersDigitsAndThreeSigns) {
  for (const auto* name : {"a", "Z9", "first-try", "first_try", "2026.11.23", "-", "_"})
    EXPECT_TRUE(is_file_name(name));
  EXPECT_TRUE(is_file_name(std::string(64, 'x')));
  EXPECT_FALSE(is_file_name(std::string(65, 'x')));
  for (const auto* name : {"a:b", "a,b", "a\\b", "a*", "~", "\xC3\xA4", "."}) EXPECT_FALSE(is_file_name(name)) << name;
}

TEST(PageRecorder, LeavesItsFolderNeverAndReplacesNothing) {
  Recorder r;
  for (const auto* name : {"../up", "/etc/x", "a/b", ".hidden", "", "a b", "x\n"})
    EXPECT_EQ(r.ask("start", name)["accepted"], false) << name;
  EXPECT_EQ(r.ask("start", "one")["accepted"], true);
  EXPECT_EQ(r.ask("start", "two")["accepted"], false);  // only one recording at a time
  EXPECT_EQ(r.ask("stop")["accepted"], true);
  EXPECT_EQ(r.ask("stop")["accepted"], false);
  EXPECT_EQ(r.ask("start", "one")["accepted"], false);  // a recording of that name exists
  EXPECT_EQ(r.recorder.request({{"record", "start"}, {"name", "three"}, {"token", "wrong"}})["accepted"], false);
}

}  // namespace
}  // namespace ligature::host::view
