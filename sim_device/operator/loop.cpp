#include "sim_device/operator/loop.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim_device/operator/ring.hpp"

namespace ligature::sim {
namespace {

/// Unit vector of the component of `a` that is perpendicular to the unit vector `along`.
Vec3 across(const Vec3& a, const Vec3& along) {
  const Vec3 rest = a - a.dot(along) * along;
  return rest.norm() > 1e-6 ? Vec3(rest.normalized()) : Vec3(along.unitOrthogonal());
}

}  // namespace

Vec3 Loop::off(const Look& look, const Vec3& p_W) const {
  const Vec3 to = p_W - look.thread.at(look.thread.nearest(p_W, 0.0, corner_s_));
  return to - to.dot(along_) * along_;
}

Vec3 Loop::towards(double angle) const { return std::cos(angle) * front_ + std::sin(angle) * up_; }

double Loop::angle_of(const Look& look, const Vec3& p_W) const {
  const Vec3 to = off(look, p_W);
  return std::atan2(to.dot(up_), to.dot(front_));
}

/// Angle by which the working part winds around the standing part between two places of the thread, rad. The angle is
/// summed in steps that are short compared with the distance between the two parts.
double Loop::wind(const Look& look, double from, double to) const {
  double sum = 0.0, before = angle_of(look, look.thread.at(from));
  const double finest = 0.1 * look.place.diameter_m;
  for (double w = from; w < to;) {
    w = std::min(to, w + std::clamp(0.3 * off(look, look.thread.at(w)).norm(), finest, 0.01 * look.place.length_m));
    const double now = angle_of(look, look.thread.at(w));
    sum += std::remainder(now - before, 2.0 * kPi);
    before = now;
  }
  return sum;
}

void Loop::look(const Look& look) {
  corner_s_ = corner_(look);
  along_ = (look.thread.at(corner_s_) - look.place.anchor_W).normalized();
  up_ = across(Vec3::UnitZ(), along_);
  front_ = static_cast<double>(side_) * across(-Vec3::UnitY(), along_);
  const double end = look.thread.length_m(), step = 0.004 * look.place.length_m, reach = 0.1 * look.place.length_m;
  const auto apart = [&](double w) { return off(look, look.thread.at(w)).norm(); };
  double most = -1.0, least = 1e9;
  const double first = std::max(corner_s_, far_ < 0.0 ? 0.0 : far_ - reach);
  const double last = far_ < 0.0 ? corner_s_ + 0.6 * (end - corner_s_) : std::min(far_ + reach, end);
  double w = first;
  while (w < last) {
    if (const double r = apart(w); r > most) most = r, far_ = w;
    w += step;
  }
  // X is the first place where the working part comes close to the standing part. A later turn may come equally close,
  // so the search ends at the first.
  w = far_;
  while (w < end - 0.7 * look.place.clearance_m) {
    const double r = apart(w);
    if (least < look.place.diameter_m * 2.0 && r > 4.0 * look.place.diameter_m) break;
    if (r < least) least = r, working_ = w;
    w += step;
  }
  standing_ = look.thread.nearest(look.thread.at(working_), 0.0, corner_s_);
  const Ring ring(look.thread.between(standing_, working_));
  centre_W_ = ring.centre();
  crossing_W_ = look.thread.at(working_);
  angle_ = angle_of(look, centre_W_);
  wound_ = std::remainder(angle_of(look, look.thread.at(far_)) - angle_, 2.0 * kPi) + wind(look, far_, end);
  normal_W_ = ring.normal().dot(way()) < 0.0 ? Vec3(-ring.normal()) : ring.normal();
}

}  // namespace ligature::sim
