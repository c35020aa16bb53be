#include "firmware/physics/simulation.hpp"

#include <algorithm>
#include <utility>

#include "firmware/physics/image.hpp"
#include "firmware/physics/member_bytes.hpp"
#include "firmware/physics/paper/paper_simulation.hpp"
#include "firmware/physics/rod/rod_simulation.hpp"

namespace ligature::physics {

namespace {

constexpr double kFarthest = 1e9;  // m or m/s; larger values count as divergence

bool is_number(const Vec3& a) noexcept { return a.cwiseAbs().maxCoeff() < kFarthest && a.allFinite(); }

bool is_number(const ToolInput& tool) noexcept {
  return is_number(tool.p_WT) && is_number(tool.v_WT) && (!tool.R_WT || tool.R_WT->coeffs().allFinite());
}

template <class Model>
ImageBytes contents(const Model& model) {
  ImageBytes bytes;
  ImageOf<ImageWriter>(bytes).visit(const_cast<Model&>(model));  // a writer changes nothing
  return bytes;
}

template <class Model>
std::uint32_t layout() {
  std::string text;
  add_layout<Model>(text);
  return checksum(std::as_bytes(std::span(text)));
}

}  // namespace

struct Simulation::Impl {
  std::variant<PaperSimulation, rod::RodSimulation> model;
  ImageOrigin origin;

  template <class Model>
  static std::variant<std::unique_ptr<Impl>, std::string> with(const scene::Scene& scene) {
    auto made = Model::make(scene);
    if (auto* why = std::get_if<std::string>(&made)) return std::move(*why);
    auto& model = *std::get_if<Model>(&made);
    const ImageOrigin origin{layout<Model>(), checksum(contents(model))};
    return std::unique_ptr<Impl>(new Impl{std::move(model), origin});
  }
};

std::variant<Simulation, std::string> Simulation::make(const scene::Scene& scene) {
  const bool is_rod = scene.suture.model == scene::Model::kRod;
  auto made = is_rod ? Impl::with<rod::RodSimulation>(scene) : Impl::with<PaperSimulation>(scene);
  if (auto* why = std::get_if<std::string>(&made)) return std::move(*why);
  return Simulation(std::move(std::get<0>(made)));
}

void Simulation::tick(const std::array<ToolInput, 2>& tools, const TimeLeft& left) noexcept {
  std::visit(
      [&](auto& model) {
        if (is_number(tools[0]) && is_number(tools[1])) return model.tick(tools, left);
        if (model.diagnostics().finite) model.stop(-1);
      },
      impl_->model);
}
void Simulation::set_work(long instructions) noexcept {
  if (auto* rod = std::get_if<rod::RodSimulation>(&impl_->model)) rod->set_work(instructions);
}
long Simulation::work() const noexcept {
  const auto* rod = std::get_if<rod::RodSimulation>(&impl_->model);
  return rod != nullptr ? rod->work() : 0;
}
void Simulation::reset() noexcept {
  std::visit([](auto& model) { model.reset(); }, impl_->model);
}
void Simulation::set_state(std::span<const Vec3> p_W, std::span<const Vec3> v_W) noexcept {
  const auto bad = [](std::span<const Vec3> all) {
    const auto at = std::ranges::find_if(all, [](const Vec3& a) { return !is_number(a); });
    return at == all.end() ? -1 : static_cast<int>(at - all.begin());
  };
  const int node = std::max(bad(p_W), bad(v_W));
  std::visit([&](auto& model) { node < 0 ? model.set_state(p_W, v_W) : model.stop(node); }, impl_->model);
}

std::vector<std::byte> Simulation::save(std::int64_t ticks) const {
  const auto bytes = std::visit([](const auto& model) { return contents(model); }, impl_->model);
  return with_header(impl_->origin, {ticks, bytes});
}
std::variant<std::int64_t, std::string> Simulation::load(std::span<const std::byte> image) {
  const auto opened = read_image(image, impl_->origin);
  if (const auto* why = std::get_if<std::string>(&opened)) return *why;
  const auto read_into = [&](Impl& impl) {
    ImageOf<ImageReader> reader(std::get<Image>(opened).contents);
    std::visit([&](auto& model) { reader.visit(model), model.loaded(); }, impl.model);
    return reader.is_complete();
  };
  if (Impl trial(*impl_); !read_into(trial))
    return std::string("the image has other lengths than this simulation: save it again");
  read_into(*impl_);  // in place: what nodes_W() has returned stays valid
  return std::get<Image>(opened).ticks;
}

bool Simulation::continue_from(const Simulation& other) noexcept {
  return std::visit(
      [&]<class ModelT>(ModelT& model) {
        const auto* same = std::get_if<ModelT>(&other.impl_->model);
        return same != nullptr && model.continue_from(*same);
      },
      impl_->model);
}

std::span<const Vec3> Simulation::nodes_W() const noexcept {
  return std::visit([](const auto& model) { return model.nodes_W(); }, impl_->model);
}
std::span<const Vec3> Simulation::velocities_W() const noexcept {
  return std::visit([](const auto& model) { return model.velocities_W(); }, impl_->model);
}
void Simulation::describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept {
  std::visit([&](const auto& model) { model.describe(tension_N, turn_rad); }, impl_->model);
}
std::size_t Simulation::contacts(std::span<ContactPoint> out) const noexcept {
  return std::visit([&](const auto& model) { return model.contacts(out); }, impl_->model);
}
const HandContact& Simulation::hand(Hand h) const noexcept {
  return std::visit([h](const auto& model) -> const HandContact& { return model.hand(h); }, impl_->model);
}
const Diagnostics& Simulation::diagnostics() const noexcept {
  return std::visit([](const auto& model) -> const Diagnostics& { return model.diagnostics(); }, impl_->model);
}

Simulation::Simulation(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Simulation::Simulation(const Simulation& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Simulation& Simulation::operator=(const Simulation& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

}  // namespace ligature::physics
