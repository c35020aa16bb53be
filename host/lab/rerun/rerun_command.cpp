#include "host/lab/rerun/rerun_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/rerun/rerun.hpp"
#include "host/lab/rerun/rerun_files.hpp"

namespace ligature::lab {
namespace {

struct Arguments {
  RerunOptions options;
  std::string out, cuts;
};

constexpr const char* kFooter = R"(
The thread of a recorded run is done again, tick by tick: the recorded tools and grips, the scenes and parameters that
came in force on the way, resets, lost periods, and ticks cut where the clock cut them.

With the recorded settings it must come out the same, to the bit: forces, nodes held, energies, stretch, gap, contacts,
time lost, and shapes (which telemetry rounds to floats). Exit 1 names the first number that differs.

With other settings (--set) the same hands do the same things to another thread. They are not led back by what they
would have felt: the tools stay where they were. The table tells what differs; time that the clock cut off is not cut
off again, since other settings ask other questions (--cuts recorded does it all the same).

--out DIR writes
  rerun.lcmlog   the recording with this thread; device forces are the recorded ones plus gain times force_scale times
                 the difference of the thread's forces, at most hands.max_force_N
  forces.csv     a row a tick: force of the thread on each hand in both, and of their difference; time lost; cost
  shapes.csv     a row a shape: how far its nodes are apart
  summary.json   the table, and the knots with their times (looked at every 0.1 s)
  rerun.png      both, drawn

Exit: 0 done, and equal where nothing was set; 1 the recorded settings come out otherwise; 2 recording or settings
refused, nothing written; 3 the run itself failed; 130 ended by SIGINT or SIGTERM, files and table hold what was played.

Examples:
  ligature-lab rerun knot.lcmlog
  ligature-lab rerun knot.lcmlog --set suture.accuracy=fast --out out/fast
  ligature-host replay knot.lcmlog --compare out/fast/rerun.lcmlog)";

std::string knots_of(const KnotHistory& history) {
  std::string text;
  for (const auto& [t_s, type] : history) text += (text.empty() ? "" : ", ") + type + " from " + digits(t_s, 4) + " s";
  return text.empty() ? "no shape" : text;
}

void print_hand(const char* name, std::size_t h, const Differences& d) {
  const auto line = [&](const ForceOf& f) {
    return digits(f.rms_N(d.ticks())) + " N rms, " + digits(f.peak_N) + " N peak";
  };
  std::printf("force %-5s  recorded %s; rerun %s; apart %s\n", name, line(d.recorded().force[h]).c_str(),
              line(d.again().force[h]).c_str(), line(d.apart()[h]).c_str());
}

void print(const RerunOutcome& o, double period_s) {
  const auto& d = o.differences;
  std::printf("%lld ticks, %.3f s, %lld shapes compared\n", static_cast<long long>(d.ticks()),
              static_cast<double>(d.ticks()) * period_s, static_cast<long long>(d.shapes()));
  if (o.unknown_ticks > 0)
    std::printf("not known   %lld ticks: %s\n", static_cast<long long>(o.unknown_ticks), o.why_unknown.c_str());
  if (o.shapes_alone > 0)
    std::printf("            %lld shapes of ticks that were not done again\n", static_cast<long long>(o.shapes_alone));
  print_hand("left", 0, d);
  print_hand("right", 1, d);
  std::printf("shape        apart %s m rms, %s m at most, at %s s\n", digits(d.shape_rms_m()).c_str(),
              digits(d.shape_largest_m()).c_str(), digits(d.shape_largest_at_s(), 4).c_str());
  const auto lost_ms = [&](const Differences::Side& side) { return digits(1e3 * period_s * side.lost_ticks); };
  std::printf("time lost    recorded %s ms; rerun %s ms\n", lost_ms(d.recorded()).c_str(), lost_ms(d.again()).c_str());
  const auto cost = [](const Differences::Side& side) {
    if (side.cost_us.empty()) return std::string("none");
    const auto s = spread_of(side.cost_us);
    return digits(s.median) + " us median, " + digits(s.p99) + " p99, " + digits(s.max) + " max";
  };
  std::printf("tick         recorded %s; rerun %s (CPU time)\n", cost(d.recorded()).c_str(), cost(d.again()).c_str());
  std::printf("knot         recorded %s; rerun %s\n", knots_of(d.recorded().knots).c_str(),
              knots_of(d.again().knots).c_str());
}

int conclude(const RerunOutcome& o, bool as_recorded) {
  const auto& d = o.differences;
  if (o.interrupted) {
    std::fprintf(stderr, "ligature-lab: interrupted after %lld of %lld ticks\n", static_cast<long long>(d.ticks()),
                 static_cast<long long>(o.ticks));
    return kInterrupted;
  }
  if (d.ticks() == 0) throw Refusal("no tick could be done again: " + o.why_unknown, kRunFailed);
  if (d.are_none()) {
    std::printf("equal        to the bit\n");
    return kDone;
  }
  std::printf("different    %lld ticks, %lld shapes; first: %s\n", static_cast<long long>(d.different_ticks()),
              static_cast<long long>(d.different_shapes()), d.first().c_str());
  return as_recorded ? kMissed : kDone;
}

int execute(Arguments a) try {
  const bool as_recorded = a.options.overrides.empty() && a.cuts != "none";
  a.options.cuts = a.cuts.empty() ? a.options.overrides.empty() : a.cuts == "recorded";
  const std::filesystem::path folder(a.out);
  if (!a.out.empty()) {
    refuse_own_output(a.options.log, folder);
    a.options.output = files_in(folder, a.options.overrides);
  }
  const auto outcome = rerun(a.options);
  if (!a.out.empty()) {
    write_text(folder / "summary.json", to_json(outcome));
    draw("rerun.py", {folder / "forces.csv", folder / "shapes.csv"}, folder / "rerun.png");
  }
  print(outcome, outcome.period_s);
  return conclude(outcome, as_recorded);
} catch (const host::BadInput& error) {
  throw Refusal(error.what());
} catch (const host::RunFailed& error) {
  throw Refusal(error.what(), console::stop_requested() ? kInterrupted : kRunFailed);
}

}  // namespace

void add_rerun_command(CLI::App& app, int& exit_code) {
  auto* rerun =
      app.add_subcommand("rerun", "Play a recording's hands through the physics again: equal, or what differs");
  auto a = std::make_shared<Arguments>();
  rerun->add_option("log", a->options.log, "LCM log of 'ligature-host record' or 'ligature-lab tie'")->required();
  rerun
      ->add_option("--set", a->options.overrides,
                   "key=value over every recorded scene, in the place of what set it; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  rerun->add_option("--out", a->out, "Folder for the files [none are written]")->type_name("DIR")->check(not_empty);
  rerun->add_option("--cuts", a->cuts, "Ticks that the clock cut: as recorded, or none [recorded; with --set none]")
      ->check(CLI::IsMember({"recorded", "none"}));
  rerun->add_option("--session", a->options.session, "Which run of the firmware, from 1, where the log holds several")
      ->type_name("N");
  rerun->footer(kFooter);
  rerun->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
