// The program as started by a user: exit codes, and one line on stderr for each error.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

class Program : public ::testing::Test {
 protected:
  /// Runs `ligature-host WORDS` in the test's folder, with stdout and stderr redirected to files there.
  int run(const std::string& words) {
    const std::string line =
        "cd '" + folder_.path().string() + "' && '" LIGATURE_HOST_PROGRAM "' " + words + " >out 2>err";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string out() const { return test::text_of(folder_.file("out")); }
  std::string err() const { return test::text_of(folder_.file("err")); }

  test::TestFolder folder_;
};

TEST_F(Program, RefusesBadInputWithOneLineAndTwo) {
  test::write_text(folder_.file("text.csv"), "x,y,z\n1,2,3\n1,b,3\n");
  test::write_text(folder_.file("there.lcmlog"), "precious");
  for (const char* words :
       {"", "nonsense", "record", "record --out there.lcmlog", "record --out new.lcmlog --lcm-url nonsense",
        "record --out new.lcmlog --duration -1", "record --out no/where.lcmlog", "export text.csv --forces f.csv",
        "export missing.lcmlog --forces f.csv", "export there.lcmlog", "plot text.csv --out f.png", "report text.csv",
        "knot text.csv", "knot missing.csv", "knot text.csv --open --closed", "knot text.csv --at x", "send nonsense",
        "report there.lcmlog extra", "--nonsense"}) {
    EXPECT_EQ(run(words), 2) << words;
    EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << words << ": " << err();
    EXPECT_EQ(out(), "") << words;
  }
  EXPECT_EQ(test::text_of(folder_.file("there.lcmlog")), "precious");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("new.lcmlog")));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("f.csv")));
}

TEST_F(Program, NeverReplacesWhatIsNoRegularFileAndWritesThroughLinks) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  log.close();
  ASSERT_EQ(mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("pipe", folder_.file("to_pipe"));
  for (const char* name : {"pipe", "to_pipe"}) {
    EXPECT_EQ(run(std::string("export a.lcmlog --forces ") + name), 2);
    EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder_.file("pipe")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.file("to_pipe")));
  test::write_text(folder_.file("real.csv"), "old");
  std::filesystem::create_symlink("real.csv", folder_.file("link.csv"));
  std::filesystem::create_symlink("new.csv", folder_.file("dangling.csv"));
  EXPECT_EQ(run("export a.lcmlog --forces link.csv --ticks dangling.csv"), 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.file("link.csv")));
  EXPECT_TRUE(test::text_of(folder_.file("real.csv")).starts_with("tick,"));
  EXPECT_TRUE(test::text_of(folder_.file("new.csv")).starts_with("tick,"));
}

TEST_F(Program, RefusesNumbersThatAreNone) {
  for (const char* words : {"record --out new.lcmlog --duration nan", "record --out new.lcmlog --duration inf",
                            "knot there.csv --at nan", "knot there.csv --at inf"}) {
    EXPECT_EQ(run(words), 2) << words;
    EXPECT_NE(err().find("finite"), std::string::npos) << words << ": " << err();
  }
}

TEST_F(Program, NamesTheOptionThatWasProbablyMeant) {
  EXPECT_EQ(run("export a.lcmlog --force f.csv"), 2);
  EXPECT_NE(err().find("did you mean --forces?"), std::string::npos) << err();
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
  EXPECT_EQ(run("export a.lcmlog --zebra=f.csv"), 2);
  EXPECT_EQ(err().find("did you mean"), std::string::npos) << err();
}

TEST_F(Program, NamesNoKnotFarFromTheTimeThatWasAskedFor) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  test::write(log, kThreadChannel, test::thread_of(500, test::overhand_points(100)));
  log.close();
  EXPECT_EQ(run("knot a.lcmlog --at 1.4"), 0) << err();
  for (const char* at : {"1.6", "99", "-1"}) {
    EXPECT_EQ(run(std::string("knot a.lcmlog --at ") + at), 2) << at;
    EXPECT_NE(err().find("nearest shape is at 0.500 s"), std::string::npos) << err();
  }
}

TEST_F(Program, SaysWhatIsDamagedInALogWhoseKnotItNames) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  for (const int tick : {0, 20}) test::write(log, kThreadChannel, test::thread_of(tick, test::overhand_points(100)));
  log.close();
  EXPECT_EQ(run("knot a.lcmlog"), 0);
  EXPECT_EQ(err(), "");
  std::filesystem::resize_file(folder_.file("a.lcmlog"), std::filesystem::file_size(folder_.file("a.lcmlog")) - 100);
  EXPECT_EQ(run("knot a.lcmlog"), 0);
  EXPECT_TRUE(out().starts_with("3_1")) << out();
  EXPECT_TRUE(err().starts_with("ligature-host: a.lcmlog: file ends inside an event")) << err();
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
}

TEST_F(Program, RefusesATraceOfASpanWithoutATick) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  log.close();
  EXPECT_EQ(run("export a.lcmlog --forces f.csv --trace t.json --trace-span 100 200"), 2);
  EXPECT_EQ(err(),
            "ligature-host: --trace-span: found 100 .. 200 s, where a.lcmlog has no tick; allowed a part of 0.000 .. "
            "0.019 s\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("f.csv")));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("t.json")));
  EXPECT_EQ(run("export a.lcmlog --forces f.csv --trace t.json --trace-span 0.01 200"), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_.file("t.json")));
}

TEST_F(Program, HelpTeachesEveryCommandByExample) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_NE(out().find("Example"), std::string::npos);
  for (const char* command : {"record", "export", "plot", "report", "knot", "send"}) {
    EXPECT_EQ(run(std::string(command) + " --help"), 0);
    EXPECT_NE(out().find(std::string("ligature-host ") + command), std::string::npos) << command;
  }
  EXPECT_EQ(run("--version"), 0);
  EXPECT_TRUE(out().starts_with("ligature-host "));
}

TEST_F(Program, ExportsReportsAndNamesTheKnotOfALog) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  test::write(log, kTicksChannel, test::batch_of(1, 0, 20));
  test::write(log, kThreadChannel, test::thread_of(0, test::overhand_points(100)));
  log.close();
  EXPECT_EQ(run("export a.lcmlog --forces f.csv --shape s.csv --ticks t.csv"), 0);
  EXPECT_EQ(out(), "exported 20 ticks and 1 shapes\n");
  EXPECT_EQ(run("report a.lcmlog"), 0);
  EXPECT_NE(out().find("20 recorded, 0 lost"), std::string::npos);
  EXPECT_EQ(run("knot a.lcmlog --json"), 0);
  EXPECT_TRUE(out().starts_with("{\"type\":\"3_1\"")) << out();
  EXPECT_EQ(run("knot s.csv"), 0);
  EXPECT_TRUE(out().starts_with("3_1")) << out();
}

}  // namespace
}  // namespace ligature::host
