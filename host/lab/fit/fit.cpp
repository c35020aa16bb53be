#include "host/lab/fit/fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::fit {
namespace {

// An unknown of the fit is kOrigin + log(value / start). It starts at kOrigin and not at zero, because numerical
// derivatives take a step in proportion to the unknown.
constexpr double kOrigin = 10.0;
constexpr double kStepSquared = 1e-12;  ///< share of the unknown, squared

/// One quantity that a law predicts: the indices of its residuals, and their rms `scatter`, which divides them.
struct Kind {
  const Law* law;
  std::size_t figure;
  std::vector<int> at;
  double scatter = 1.0;
};

struct Problem {
  const std::vector<Measurement>& all;
  std::vector<Parameter> free;
  Parameters start;
  std::vector<Kind> kinds;
  int count = 0;

  [[nodiscard]] Parameters at(const Eigen::VectorXd& logs) const {
    Parameters p = start;
    for (std::size_t k = 0; k < free.size(); ++k)
      p[free[k]] = start[free[k]] * std::exp(logs[static_cast<int>(k)] - kOrigin);
    return p;
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& logs) const {
    const Parameters p = at(logs);
    Eigen::VectorXd r(count);
    int row_at = 0;
    for (const auto& m : all) {
      const auto figures = m.law->figures.size();
      for (const auto& row : m.rows) {
        m.law->residuals(p, row, {r.data() + row_at, figures});
        row_at += static_cast<int>(figures);
      }
    }
    return r;
  }
  void weigh(Eigen::VectorXd& r) const {
    for (const auto& kind : kinds) {
      for (const int k : kind.at) r[k] /= kind.scatter;
    }
  }
};

Problem problem_of(const std::vector<Measurement>& all) {
  // The fit starts from a common suture: only the orders of magnitude must be right. The unloaded length starts from
  // the shortest measured length.
  Problem p{all, {}, {8e-5, 1.0, 70.0, 0.3, 4e-7, 1e-3, 2.0}, {}};
  double shortest = 1e300;
  for (const auto& m : all) {
    for (const auto wanted : m.law->finds) {
      if (std::find(p.free.begin(), p.free.end(), wanted) == p.free.end()) p.free.push_back(wanted);
    }
    if (m.law->finds.front() == kNatural) {
      for (const auto& row : m.rows) shortest = std::min(shortest, row[1]);
      p.start[kNatural] = shortest;
    }
    for (std::size_t f = 0; f < m.law->figures.size(); ++f) {
      auto kind =
          std::find_if(p.kinds.begin(), p.kinds.end(), [&](const Kind& k) { return k.law == m.law && k.figure == f; });
      if (kind == p.kinds.end()) kind = p.kinds.insert(kind, {m.law, f, {}});
      for (std::size_t row = 0; row < m.rows.size(); ++row)
        kind->at.push_back(p.count + static_cast<int>(row * m.law->figures.size() + f));
    }
    p.count += static_cast<int>(m.rows.size() * m.law->figures.size());
  }
  return p;
}

/// What Eigen's solver asks for.
struct Functor {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming): Eigen's names
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
  const Problem* problem;
  [[nodiscard]] int inputs() const { return static_cast<int>(problem->free.size()); }
  [[nodiscard]] int values() const { return problem->count; }
  int operator()(const Eigen::VectorXd& logs, Eigen::VectorXd& r) const {
    r = problem->residuals(logs);
    problem->weigh(r);
    return 0;
  }
};
using Numerical = Eigen::NumericalDiff<Functor, Eigen::Central>;

bool solve(const Problem& problem, Eigen::VectorXd& logs) {
  Numerical functor(Functor{&problem}, kStepSquared);
  Eigen::LevenbergMarquardt<Numerical> solver(functor);
  solver.parameters.maxfev = 2000;
  solver.parameters.xtol = solver.parameters.ftol = 1e-10;
  const auto end = solver.minimize(logs);
  return end != Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation &&
         end != Eigen::LevenbergMarquardtSpace::ImproperInputParameters && logs.allFinite();
}

double rms(const Eigen::VectorXd& r, const std::vector<int>& at) {
  double sum = 0.0;
  for (const int k : at) sum += r[k] * r[k];
  return std::sqrt(sum / static_cast<double>(at.size()));
}

/// Degrees of freedom of the measurements that determine a parameter.
double freedom(const Problem& problem, Parameter which) {
  double count = 0.0, taken = 0.0;
  for (const auto& kind : problem.kinds) {
    const auto& finds = kind.law->finds;
    if (std::find(finds.begin(), finds.end(), which) == finds.end()) continue;
    count += static_cast<double>(kind.at.size());
    taken = std::max(taken, static_cast<double>(finds.size()));
  }
  return std::max(1.0, count - taken);
}

/// Quantile of Student's t for a 95 % interval: by Cornish-Fisher's expansion of the normal quantile.
double student_95(double freedom) {
  const double z = 1.959964, z3 = z * z * z;
  return z + (z3 + z) / (4.0 * freedom) + (5.0 * z3 * z * z + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom);
}

/// Why a value cannot stand in a scene, as the reader of scenes says it; empty: it can.
std::string objection_to(const Told& told, const Estimate& e) {
  constexpr double kVague = 10.0;
  const std::string value = lab::digits(e.value, kDigits);
  // The interval is also zero where the laws do not depend on the value any more.
  if (!(e.half_95 > 0.0 && e.half_95 <= kVague * e.value)) {
    return std::string(told.name) + ": found " + value + " +- " + lab::digits(e.half_95, 2) +
           ", allowed a value that the rows tell better than by a factor of ten";
  }
  if (*told.table == '\0') return {};
  std::string text = "[suture]\nmodel = \"rod\"\n";
  if (told.table != std::string("suture")) text += "[" + std::string(told.table) + "]\n";
  const auto read = scene::parse_scene(text + told.name + " = " + value + "\n", "");
  const auto* error = std::get_if<scene::Error>(&read);
  return error == nullptr ? std::string() : error->text.substr(error->text.find("key "));
}

}  // namespace

Fitted fit(const std::vector<Measurement>& all) {
  auto problem = problem_of(all);
  Eigen::VectorXd logs = Eigen::VectorXd::Constant(static_cast<int>(problem.free.size()), kOrigin);
  // The scatter of a kind of figure is only known after a fit, so fit, weigh, and fit again.
  for (int pass = 0; pass < 4; ++pass) {
    if (!solve(problem, logs)) throw lab::Refusal("fit: no material explains the measurements", lab::kRunFailed);
    const auto r = problem.residuals(logs);
    for (auto& kind : problem.kinds) {
      const auto rows = static_cast<double>(kind.at.size());
      const double taken = static_cast<double>(kind.law->finds.size()) / static_cast<double>(kind.law->figures.size());
      kind.scatter = std::max(1e-7, rms(r, kind.at) * std::sqrt(rows / std::max(1.0, rows - taken)));
    }
  }
  Numerical functor(Functor{&problem}, kStepSquared);
  Eigen::MatrixXd slope(problem.count, logs.size());
  functor.df(logs, slope);
  const Eigen::MatrixXd covariance =
      (slope.transpose() * slope).ldlt().solve(Eigen::MatrixXd::Identity(logs.size(), logs.size()));
  Fitted fitted;
  const auto p = problem.at(logs);
  const auto r = problem.residuals(logs);
  for (std::size_t k = 0; k < problem.free.size(); ++k) {
    const auto which = problem.free[k];
    const auto at = static_cast<int>(k);
    fitted.found[which] =
        Estimate{p[which], p[which] * student_95(freedom(problem, which)) * std::sqrt(covariance(at, at))};
  }
  for (const auto& kind : problem.kinds)
    fitted.misfits.push_back({kind.law, kind.law->figures[kind.figure], rms(r, kind.at), kind.at.size()});
  return fitted;
}

std::vector<std::string> leave_out_impossible(Fitted& fitted) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < kParameters; ++k) {
    auto& found = fitted.found[k];
    const std::string why = found ? objection_to(kTold[k], *found) : std::string();
    if (why.empty()) continue;
    lines.push_back(why);
    found.reset();
  }
  return lines;
}

}  // namespace ligature::fit
