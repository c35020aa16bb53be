#include "firmware/control/any_pose.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::control {
namespace {

// Lower bound of 1 - |x|, where x is the sine of the angle between the links. It avoids a division by zero in the
// singular pose |x| = 1, near which the allowed force goes to 0.
constexpr double kNearStretched = 1e-6;

/// Smallest and largest |x| for x in [low, high].
struct Span {
  Span(double low, double high) noexcept
      : least(low <= 0.0 && high >= 0.0 ? 0.0 : std::min(std::abs(low), std::abs(high))),
        most(std::max(std::abs(low), std::abs(high))) {}
  double least, most;
};

}  // namespace

AnyPose::AnyPose(const device::Device& d) noexcept {
  if (d.kinematics == device::Kinematics::kOmniSerial) {
    per_m_ = Vec3(1.0, 1.0 / d.links_m[0], 1.0 / d.links_m[1]);
    cut(d);
  } else {
    per_m_ = vector_of(d.links_m).cwiseInverse();
    slices_.fill({1.0, 1.0, 1.0});
  }
}

void AnyPose::cut(const device::Device& d) noexcept {
  const Span x(d.workspace_min_m[0], d.workspace_max_m[0]), y(d.workspace_min_m[1], d.workspace_max_m[1]),
      z(d.workspace_min_m[2], d.workspace_max_m[2]);
  const double near_m = std::hypot(x.least, y.least), far_m = std::hypot(x.most, y.most);
  const double l1 = d.links_m[0], l2 = d.links_m[1];
  const auto sine = [&](double rho_m, double z_m) {
    return (rho_m * rho_m + z_m * z_m - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  };
  for (std::size_t i = 0; i < kSlices; ++i) {
    const double step_m = (far_m - near_m) / kSlices;
    const double from_m = near_m + step_m * static_cast<double>(i), to_m = from_m + step_m;
    slices_[i] = {1.0 / std::max(from_m * from_m, kNearStretched),
                  1.0 / std::max(1.0 - sine(to_m, z.most), kNearStretched),
                  1.0 / std::max(1.0 + sine(from_m, z.least), kNearStretched)};
  }
}

double AnyPose::most_of_slices(double waist, double a, double b) const noexcept {
  const double apart = 0.5 * (a - b) * (a - b), along = 0.5 * (a + b) * (a + b);
  double most = 0.0;
  for (const Slice& s : slices_) most = std::max(most, s.u * waist + s.v * apart + s.w * along);
  return most;
}

double AnyPose::most_N(const Vec3& torque_Nm) const noexcept {
  const Vec3 f = torque_Nm.cwiseProduct(per_m_);
  return std::sqrt(most_of_slices(f[0] * f[0], f[1], f[2]));
}

double AnyPose::most_N(const Vec3& low_Nm, const Vec3& high_Nm) const noexcept {
  const Vec3 low = low_Nm.cwiseProduct(per_m_), high = high_Nm.cwiseProduct(per_m_);
  const double waist = std::max(low[0] * low[0], high[0] * high[0]);
  double most = 0.0;
  for (const double a : {low[1], high[1]})  // a convex function has its maximum at a corner
    for (const double b : {low[2], high[2]}) most = std::max(most, most_of_slices(waist, a, b));
  return std::sqrt(most);
}

}  // namespace ligature::control
