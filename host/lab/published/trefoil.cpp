// A trefoil (open overhand knot) in an elastic thread, drawn tight with little friction.

#include <cmath>
#include <numbers>

#include "host/lab/published/sliding_knot.hpp"

namespace ligature::published {
namespace {

constexpr double kFriction = 0.05;

/// F h^2 / B by the theory, eps = sqrt(h / R): F tension, h thread radius, R loop radius, B bending stiffness.
double theory(double eps) { return 0.5 * std::pow(eps, 4) + 0.492 * kFriction * std::pow(eps, 3); }

std::string text(double value) { return std::to_string(value).substr(0, 5); }

}  // namespace

Result trefoil(const Subject& subject) {
  Result result;
  for (const double eps : subject.quick ? std::vector{0.1} : std::vector{0.05, 0.075, 0.1, 0.125}) {
    KnotPlan plan;
    plan.friction = kFriction;
    plan.excess_h = 2.0 * std::numbers::pi / (eps * eps);
    plan.nodes = subject.quick ? 100 : 200;
    const auto knot = draw_knot(subject, plan);
    const std::string at = "excess 2 pi h/" + text(eps) + "^2: ";
    const double peak = std::sqrt(knot.peak_curvature), top = std::sqrt(knot.top_curvature);
    result.findings.push_back(validate::relative(at + "F h^2/B, R of the peak curvature, eps = " + text(peak),
                                                 theory(peak), knot.tension, 0.15));
    result.findings.push_back(
        reported(at + "measured over theory, R of the loop's top", knot.tension / theory(top), ""));
    result.findings.push_back(reported(at + "measured over theory, R = excess / 2 pi", knot.tension / theory(eps), ""));
    result.points.push_back({"R of the peak curvature", peak, theory(peak), knot.tension});
    result.points.push_back({"R = excess / 2 pi", eps, theory(eps), knot.tension});
  }
  return result;
}

}  // namespace ligature::published
