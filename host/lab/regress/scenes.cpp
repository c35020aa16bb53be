#include "host/lab/regress/scene.hpp"

namespace ligature::regress {
namespace {

using scene::Accuracy;
using scene::Model;

constexpr RegressScene kScenes[] = {
    {"overhand", "a loose overhand is drawn to 1 N and held, mean of 8 pulls", false, overhand},
    {"figure-eight", "the same with a figure-eight, in a thread whose bends stay", false, figure_eight},
    {"square", "the same with a square knot", false, square},
    {"granny", "the same with a granny", false, granny},
    {"surgeons", "the same with a surgeon's knot", false, surgeons},
    {"desk", "a thread slides on a desk until it stops", true, desk},
    {"static-friction", "a thread on a tilted desk, held by static friction alone", true, static_friction},
    {"peg", "a thread slips half a turn round a peg", true, peg},
    {"drum", "a drum turns below a thread that is held, half a turn round it", true, drum},
    {"gripper", "an open gripper pushes a hanging thread aside", true, gripper},
    {"clamp-and-load", "a clamped thread is bent by its weight and a load", true, clamp_and_load},
    {"jaws", "jaws of finite width and force slip along a thread", true, jaws},
    {"frame", "the paper's thread is thrown against the hook of the frame", true, frame},
    {"curl", "a thread that is a helix when unloaded hangs under its weight", true, curl},
    {"set", "a thread is bent sharply and let go: a part of the bend stays", true, set_bends},
    {"swing-fast", "the rod at `fast` swings down from a horizontal arc", true, rod_swing<Accuracy::kFast>},
    {"swing-balanced", "the rod at `balanced`", true, rod_swing<Accuracy::kBalanced>},
    {"swing-fine", "the rod at `fine`", true, rod_swing<Accuracy::kFine>},
    {"swing-paper-1", "the paper's thread swings down, model 1", true, swing<Model::kPaper1>},
    {"swing-paper-2", "model 2", true, swing<Model::kPaper2>},
    {"swing-paper-3", "model 3", true, swing<Model::kPaper3>},
    {"swing-paper-4", "model 4", true, swing<Model::kPaper4>},
    {"swing-paper-5", "model 5", true, swing<Model::kPaper5>},
    {"paper-overhand", "the paper's overhand, tied by the shipped script", false, paper_overhand},
};

}  // namespace

std::span<const RegressScene> all_scenes() { return kScenes; }

}  // namespace ligature::regress
