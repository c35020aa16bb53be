#include "host/view/page_recorder.hpp"

#include "host/errors.hpp"
#include "host/view/json_text.hpp"
#include "host/view/recordings.hpp"
#include "host/wall_clock.hpp"

namespace ligature::host::view {
using nlohmann::json;

PageRecorder::PageRecorder(const Access& access, std::filesystem::path folder, Picture& picture)
    : access_(access), folder_(std::move(folder)), picture_(picture) {
  tell();
}

json PageRecorder::request(const json& message) {
  const std::string word = "record " + text_of(message, "record").substr(0, 10);
  const auto answer = [&](bool accepted, const std::string& text) {
    return json{{"id", id_of(message)}, {"command", word}, {"accepted", accepted}, {"text", text}};
  };
  if (!is_token(text_of(message, "token"), access_.token))
    return answer(false, "recording needs the token of this view");
  if (word == "record list") {
    auto listed = answer(true, folder_.string());
    listed["files"] = recordings_in(folder_);
    return listed;
  }
  const std::scoped_lock lock(mutex_);
  try {
    if (word == "record start") return answer(true, start(text_of(message, "name"), text_of(message, "notes")));
    if (word != "record stop") return answer(false, "allowed start, stop, list");
    if (!log_) return answer(false, "nothing is being recorded");
    const std::string done = file_ + ", " + std::to_string(messages_) + " messages";
    stop("");
    return answer(true, done);
  } catch (const std::exception& error) {
    return answer(false, error.what());
  }
}

std::string PageRecorder::start(const std::string& name, const std::string& notes) {
  if (log_) throw BadInput(file_ + " is being recorded");
  if (!is_file_name(name)) throw BadInput("a name has letters, digits, '-', '_' and '.', at most 64 of them");
  if (notes.size() > kLongestNotes) throw BadInput("notes have at most 2000 bytes");
  const auto path = folder_ / (name.ends_with(".lcmlog") ? name : name + ".lcmlog");
  log_ = std::make_unique<LogWriter>(path.string(), false);
  file_ = path.filename().string();
  messages_ = 0;
  if (!notes.empty()) log_->write(now_us(), kNotesChannel, std::as_bytes(std::span(notes)));
  tell();
  return path.string();
}

void PageRecorder::stop(const std::string& why) {
  const auto log = std::exchange(log_, nullptr);
  tell(why);
  log->close();
}

void PageRecorder::take(const Message& message) {
  const std::scoped_lock lock(mutex_);
  if (!log_ || !LogWriter::takes(message.channel, message.data)) return;
  try {
    log_->write(message.received_us, message.channel, message.data);
    ++messages_;
  } catch (const std::exception& error) {
    const std::string why = error.what();
    log_.reset();
    tell(why);
  }
}

void PageRecorder::tell(const std::string& why) {
  picture_.set("recording", {{"on", log_ != nullptr}, {"file", file_}, {"why", why}});
}

}  // namespace ligature::host::view
