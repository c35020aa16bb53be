#pragma once
#include <cstdint>
#include <string>

#include "host/rig_facts.hpp"
#include "ligature_msg/event_t.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// One output format of `export`. Each tick arrives once and in order; other messages arrive in the order of reception.
class ExportSink {
 public:
  virtual ~ExportSink() = default;
  /// @param session 1, 2, .. in order of appearance.
  virtual void add(const ligature_msg::tick_t& tick, double t_s, int session) = 0;
  virtual void add(const ligature_msg::thread_t& thread, double t_s) { (void)thread, (void)t_s; }
  virtual void add(const ligature_msg::event_t& event, double t_s) { (void)event, (void)t_s; }
  /// The status message of the scene in force from here on; called only when the scene's text changes.
  virtual void add(const ligature_msg::status_t& status, double t_s) { (void)status, (void)t_s; }
  /// A note that a person typed into the recording. commit() writes all of them into the file, a line each.
  void note(const std::string& text) { notes_ += (notes_.empty() ? "" : "\n") + text; }
  /// Called after the last message, before any sink's commit(). @throws BadInput when the recording has nothing of what
  /// the sink was asked for; then no file is written.
  virtual void check() const {}
  /// Completes the file and gives it its final name. @throws RunFailed.
  virtual void commit() = 0;

 protected:
  std::string notes_;
};

}  // namespace ligature::host
