#include "protocol/scene/scene_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "ligature_source_dir.hpp"
#include "protocol/scene/fault_script.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/polyline.hpp"
#include "protocol/scene/text_file.hpp"
#include "protocol/scene/toml_text.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::scene {
namespace {

/// Writes a file into the test's temporary folder. @return its path.
std::string write(const std::string& name, const std::string& text) {
  const auto path = test::temp_folder() + name;
  std::ofstream(path) << text;
  return path;
}

/// The error that this scene text gives, "" if none.
std::string why_refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto read = load_scene(write("scene.toml", text), overrides);
  const auto* error = std::get_if<Error>(&read);
  return error ? error->text : "";
}

TEST(SceneFile, AFileWithoutASutureIsNoScene) {
  for (const char* text : {"", "# nothing\n", "[time]\ntick_s = 0.001\n"})
    EXPECT_NE(why_refused(text).find("no [suture] table"), std::string::npos) << text;
  EXPECT_EQ(why_refused("[suture]\n"), "");
}

TEST(SceneFile, ReadsTheShippedScenes) {
  // With the height of the frame in m.
  const std::pair<const char*, double> scenes[] = {{"paper.toml", 5.5}, {"desk.toml", 1.1}};
  for (const auto& [name, frame_m] : scenes) {
    const auto read = load_scene(std::string(LIGATURE_SOURCE_DIR "/scenes/") + name);
    ASSERT_TRUE(std::holds_alternative<Scene>(read)) << std::get<Error>(read).text;
    const auto& s = std::get<Scene>(read);
    EXPECT_EQ(s.suture.nodes, 50);
    EXPECT_EQ(s.suture.paper.node_mass_kg, 0.05);
    EXPECT_EQ(s.hands.coupling_N_per_m, 1200.0);
    ASSERT_EQ(s.world.fixed.size(), 1u);
    EXPECT_EQ(s.world.fixed[0].position_m, (Vec{0.0, 0.0, frame_m}));
  }
}

TEST(SceneFile, AnEmptySutureIsTheDefaultScene) {
  const auto read = load_scene(write("empty.toml", "[suture]\n"));
  ASSERT_TRUE(std::holds_alternative<Scene>(read));
  EXPECT_EQ(std::get<Scene>(read).suture.nodes, 50);
}

TEST(SceneFile, NamesFileLineKeyFoundAndAllowed) {
  const auto why = why_refused("[suture]\n\nnodes = 1\n");
  EXPECT_EQ(why, test::temp_folder() + "scene.toml:3: key 'suture.nodes': found 1, allowed integer 2 .. 5000");
}

TEST(SceneFile, EveryRefusalIsOneLineWithItsLineNumber) {
  const struct {
    const char* text;
    int line;
    const char* key;
  } kCases[] = {
      {"[suture]\nlenght_m = 5.0\n", 2, "suture.lenght_m"},
      {"[sutura]\nnodes = 5\n", 1, "sutura"},
      {"[suture]\n\"\\u001b[2J\" = 5\n", 2, "'suture.\\x1B[2J'"},  // escape sequences are not printed raw
      {"nodes = 5\n", 1, "nodes"},
      {"[suture]\nnodes = 5.0\n", 2, "suture.nodes"},
      {"[suture]\nnodes = \"5\"\n", 2, "suture.nodes"},
      {"[suture]\nlength_m = nan\n", 2, "suture.length_m"},
      {"[suture]\n[hands]\nreach_m = 0.0\n", 3, "hands.reach_m"},
      {"[suture]\n[hands]\nreach_m = inf\n", 3, "hands.reach_m"},
      {"[suture]\n[hands]\nreach_m = 0.049\n", 3, "hands.reach_m"},
      {"[suture]\nlength_m = inf\n", 2, "suture.length_m"},
      {"[suture]\nradius_m = 0\n", 2, "suture.radius_m"},
      {"[suture]\nmodel = \"paper-6\"\n", 2, "paper-1"},
      {"[suture]\nmodel = \"rope\"\n", 2, "\"rod\""},
      {"[suture]\ninitial = \"no-such.csv\"\n", 2, "no-such.csv"},
      {"[world]\ngravity_m_per_s2 = [0, 0]\n", 2, "world.gravity_m_per_s2"},
      {"[world]\ngravity_m_per_s2 = [0, 0, nan]\n", 2, "world.gravity_m_per_s2"},
      {"[world]\nfixed = [{node = 50, position_m = [0, 0, 0]}]\n", 2, "world.fixed[0].node"},
      {"[world]\nfixed = [{node = 0}]\n", 2, "position_m"},
      {"[world]\nfixed = [{node = 49, position_m = [0,0,0]}, {node = -1, position_m = [0,0,0]}]\n", 2,
       "world.fixed[1].node"},
      {"[world]\nfixed = 3\n", 2, "world.fixed"},
      {"[world]\ngrippers_collide = [0.05, [1, {a = 1}]]\n", 2, "found [0.05, [1, a table]], allowed"},
      {"[world]\ngrippers_collide = 1\n", 2, "world.grippers_collide"},
      {"[contact]\nfriction = -1\n", 2, "contact.friction"},
      {"[suture]\nbend_damping = -1\n", 2, "suture.damping = \"explicit\""},
      {"[suture]\nswivel_damping = -1\nswivel = \"paper\"\n", 2, "suture.damping = \"explicit\""},
      {"[suture]\nswivel_damping = -1\ndamping = \"explicit\"\n", 2, "suture.swivel = \"paper\""},
      {"[suture]\nstretch_damping = -1\ndamping = \"explicit\"\n", 2, "suture.stretch_damping"},
      {"[contact]\nfriction = 0.5\nstatic_friction = 0.2\n", 3, "contact.static_friction"},
      {"[suture]\nmodel = \"rod\"\nrest_curvature_per_m = -1\n", 3, "suture.rest_curvature_per_m"},
      {"[suture]\nmodel = \"rod\"\nyield_strain = 0\n", 3, "suture.yield_strain"},
      {"[suture]\nmodel = \"rod\"\nset_fraction = 1.5\n", 3, "suture.set_fraction"},
      {"[suture]\nmodel = \"rod\"\nstiffness_profile = 3\n", 3, "suture.stiffness_profile"},
      {"[suture]\nmodel = \"rod\"\nstiffness_profile = [{from_m = 0, to_m = 1}]\n", 3, "EI_N_m2"},
      {"[suture]\nmodel = \"rod\"\nstiffness_profile = [{from_m = 1, to_m = 1, EI_N_m2 = 1}]\n", 3, "[0].to_m"},
      {"[suture]\nmodel = \"rod\"\nstiffness_profile = [{from_m = 0, to_m = 6, EI_N_m2 = 1}]\n", 3, "[0].to_m"},
      {"[suture]\nmodel = \"rod\"\nstiffness_profile = [{from_m = 0, to_m = 2, EI_N_m2 = 1}, {from_m = 1, to_m = 3, "
       "EI_N_m2 = 1}]\n",
       3, "[1].from_m"},
      {"[time]\ntick_s = 0\n", 2, "time.tick_s"},
      {"[time\ntick_s = 0\n", 1, "TOML"},
      {"[time]\ntick_s = 0.001\ntick_s = 0.002\n", 3, "TOML"},
  };
  for (const auto& c : kCases) {
    const auto why = why_refused(c.text);
    EXPECT_NE(why.find("scene.toml:" + std::to_string(c.line) + ":"), std::string::npos) << c.text << why;
    EXPECT_NE(why.find(c.key), std::string::npos) << c.text << why;
    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
  }
}

// Keys of another thread model are rejected, because they would silently have no effect.
TEST(SceneFile, AKeyOfAnotherModelIsRefused) {
  const struct {
    const char *table, *keys;
    bool of_rod;
  } kTables[] = {
      {"suture", "density_kg_per_m EA_N EI_N_m2 GJ_N_m2 rest_curvature_per_m rest_twist_per_m damping_s", true},
      {"suture", "preset yield_strain set_fraction stiffness_profile stretch_damping_s spacing accuracy", true},
      {"suture", "node_mass_kg stretch_N stretch_damping bend bend_damping swivel_damping", false},
      {"suture", "reference_nodes damping integrator swivel quadratic_stretch", false},
      {"contact", "turns_thread", true},
      {"contact", "repulsion_N_per_m repulsion_N_s_per_m friction_cap broad_phase", false},
      {"world", "pegs", true},
      {"world", "frame_collides", false},
      {"hands", "pinch_width_m pinch_force_N", true},
      {"hands", "propagation min_length max_length", false},
  };
  for (const auto& t : kTables) {
    const std::string model = std::string("[suture]\nmodel = ") + (t.of_rod ? "\"paper-1\"\n" : "\"rod\"\n");
    const std::string owner = t.of_rod ? "\"rod\" only" : "\"paper-1\" .. \"paper-5\" only";
    const bool opened = t.table == std::string("suture");
    std::istringstream keys(t.keys);
    for (std::string key; keys >> key;) {
      const auto why = why_refused(model + (opened ? "" : std::string("[") + t.table + "]\n") + key + " = 1\n");
      EXPECT_EQ(why, test::temp_folder() + "scene.toml:" + (opened ? "3" : "4") + ": key '" + t.table + "." + key +
                         "': found 1, allowed with suture.model " + owner);
    }
  }
  EXPECT_EQ(why_refused("[suture]\nair_drag_per_s = 1\n[hands]\nreach_m = 0.1\n"), "");  // keys of both models
  EXPECT_EQ(why_refused("[suture]\nmodel = \"rod\"\nair_drag_per_s = 1\n[hands]\nreach_m = 0.1\n"), "");
}

TEST(SceneFile, ThePapersContactTakesNoObstacles) {
  const std::string paper = "[suture]\n[contact]\nsolver = \"paper\"\n[world]\n";
  for (const std::string asked : {"desk_height_m = 0.0", "grippers_collide = true", "frame_collides = true"}) {
    const auto why = why_refused(paper + asked + "\n");
    const auto key = asked.substr(0, asked.find(' '));
    EXPECT_TRUE(why.starts_with(test::temp_folder() + "scene.toml:5: key 'world." + key + "': found ")) << why;
    EXPECT_TRUE(why.ends_with("with contact.solver = \"paper\", which separates the thread from itself alone")) << why;
    EXPECT_EQ(why_refused("[suture]\n[world]\n" + asked + "\n"), "");
  }
  EXPECT_EQ(why_refused(paper + "grippers_collide = false\nframe_collides = false\n"), "");
  const auto scene = std::get<Scene>(load_scene(write("scene.toml", paper), {}));
  EXPECT_FALSE(scene.world.grippers_collide || scene.world.frame_collides);
}

TEST(SceneFile, RefusesAMissingFileAndAFolder) {
  EXPECT_NE(std::get<Error>(load_scene("no/such.toml")).text.find("no/such.toml: cannot be read"), std::string::npos);
  EXPECT_NE(std::get<Error>(load_scene(test::temp_folder())).text.find("cannot be read"), std::string::npos);
}

TEST(SceneFile, ReadsRegularFilesOnlyAndNeverWaits) {
  const std::string pipe = test::temp_folder() + "pipe", device = "/dev/zero";
  ::unlink(pipe.c_str());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, device}) {
    const auto said = [&](const Error& error) {
      EXPECT_NE(error.text.find(path + ": cannot be read: found a pipe or device, allowed a regular file"),
                std::string::npos)
          << error.text;
    };
    said(std::get<Error>(load_scene(path)));
    said(std::get<Error>(load_fault_script(path)));
    said(std::get<Error>(load_gripper_script(path)));
    said(std::get<Error>(load_polyline(path)));
    said({why_refused("[suture]\ninitial = \"" + path + "\"\n")});
  }
}

TEST(SceneFile, ReadsFilesOfABoundedSizeOnly) {
  const auto big = write("big.toml", "[suture]\n#" + std::string(kMostScene_bytes, '.'));
  EXPECT_EQ(std::get<Error>(load_scene(big)).text, big + ": found 1048586 bytes, allowed 1048576 at most");
  std::filesystem::resize_file(big, kMostScene_bytes);
  EXPECT_TRUE(std::holds_alternative<Scene>(load_scene(big)));
  const auto sparse = write("sparse.csv", "x,y,z\n0,0,0\n");
  std::filesystem::resize_file(sparse, std::uintmax_t{60} << 30);
  EXPECT_NE(std::get<Error>(load_polyline(sparse)).text.find("allowed 16777216 at most"), std::string::npos);
  std::string rows = "x,y,z\n";
  for (std::size_t i = 0; i < kMostRows; ++i) rows += "0,0,0\n";
  EXPECT_TRUE(std::holds_alternative<std::vector<Vec>>(load_polyline(write("rows.csv", rows))));
  EXPECT_NE(std::get<Error>(load_polyline(write("rows.csv", rows + "0,0,0\n"))).text.find("rows.csv:200002: found"),
            std::string::npos);
}

TEST(SceneFile, NestsToABoundedDepthOnly) {
  std::string key = "a", quoted = "\"a\"", list = "1";
  for (int i = 0; i < 1'000'000; ++i) key += ".a";
  for (int i = 0; i < 100'000; ++i) quoted += " . \"a\"";
  for (int i = 0; i < 100'000; ++i) list.insert(0, 1, '[');
  for (const auto& line : {key + " = 1", "[" + key + "]", "b = {" + quoted + " = 1}", "b = " + list}) {
    const auto why = why_refused("[suture]\n" + line.substr(0, kMostScene_bytes - 100) + "\n");
    EXPECT_EQ(why, test::temp_folder() +
                       "scene.toml:2: nested too deep, allowed 8 dots in a key and as many brackets "
                       "in one another");
  }
  EXPECT_NE(why_refused("[suture]\n", {key + "=1"}).find("nested too deep, allowed 8 dots"), std::string::npos);
  EXPECT_EQ(why_refused("[suture]\n# a.b.c.d.e.f.g.h.i.j.k\nlength_m = 5.0\ninitial = \"hanging\"\n"), "");
  EXPECT_NE(why_refused("[suture]\ninitial = \"a.b.c.d.e.f.g.h.i.j.k.csv\"\n").find("cannot be read"),
            std::string::npos)
      << "dots in a text are none of a key";
}

// Values that no thread can have are typing errors; with them, rounding would make the simulation fail.
TEST(SceneFile, RefusesWhatNoThreadCanBe) {
  for (const char* set :
       {"suture.radius_m=1e-300", "suture.length_m=5e-324", "suture.node_mass_kg=1e-300", "suture.stretch_N=1e12",
        "world.gravity_m_per_s2=[0,0,-1e300]", "world.fixed=[{node=0,position_m=[1e5,0,0]}]",
        "world.fixed=[{node=0,position_m=[0,0,0],direction=[5e-324,0,0]}]", "hands.workspace_scale=1e-300",
        "hands.reach_m=1e-300", "hands.device_N_per_m=1e-300", "hands.min_length=1e-300", "time.substeps=40001"}) {
    const auto why = why_refused("[suture]\n", {set});
    EXPECT_NE(why.find("allowed"), std::string::npos) << set << " -> " << why;
  }
  for (const char* set : {"suture.density_kg_per_m=1e-300", "suture.EA_N=1e-300", "suture.yield_strain=1e-300",
                          "hands.pinch_force_N=1e-300", "world.pegs=[{from_m=[0,0,0],to_m=[1,0,0],radius_m=1e-300}]"}) {
    const auto why = why_refused("[suture]\n", {"suture.model=rod", set});
    EXPECT_NE(why.find("allowed"), std::string::npos) << set << " -> " << why;
  }
  EXPECT_EQ(why_refused("[suture]\nnodes = 5000\n[time]\nsubsteps = 401\n"),
            test::temp_folder() + "scene.toml:4: key 'time.substeps': found 401, allowed 400 at most with 5000 nodes");
}

TEST(SceneFile, OverridesReachEveryKindOfKey) {
  const std::vector<std::string> set{"suture.nodes=35", "contact.friction = 1", "suture.model=paper-1",
                                     "world.loads=[{node=-1, force_N=[0,0,-1e-3]}]", "world.desk_height_m=0.5"};
  const auto read = load_scene(write("empty.toml", "[suture]\n"), set);
  ASSERT_TRUE(std::holds_alternative<Scene>(read)) << std::get<Error>(read).text;
  const auto& s = std::get<Scene>(read);
  EXPECT_EQ(s.suture.nodes, 35);
  EXPECT_EQ(s.contact.friction, 1.0);
  EXPECT_EQ(s.suture.model, Model::kPaper1);
  ASSERT_EQ(s.world.loads.size(), 1u);
  EXPECT_EQ(s.world.loads[0].force_N[2], -1e-3);
  EXPECT_EQ(s.world.desk_height_m, 0.5);
}

TEST(SceneFile, OverridesAreCheckedLikeTheFileAndNamedAsOverrides) {
  for (const char* set :
       {"suture.nodes=1", "suture.nods=5", "suture.nodes", "=3", "suture.nodes=", "suture.nodes=nan", "suture=3",
        "suture.nodes.deep=3", "world.loads=[{node=-1, force=[0,0,0]}]", "time.tick_s=[1"}) {
    const auto why = why_refused("[suture]\n", {set});
    EXPECT_EQ(why.find(std::string("--set ") + set), 0u) << set << " -> " << why;
  }
}

// The override fits its own range; the file's key is the one that no longer fits.
TEST(SceneFile, ARuleBetweenKeysNamesTheOverridesToo) {
  EXPECT_EQ(why_refused("[suture]\n[hands]\nreach_m = 0.06\n", {"suture.radius_m=0.15", "suture.nodes=20"}),
            test::temp_folder() +
                "scene.toml:3: key 'hands.reach_m': found 0.06, allowed suture.radius_m or more: it "
                "goes to the thread's middle; with --set suture.nodes=20 --set suture.radius_m=0.15");
  EXPECT_EQ(why_refused("[suture]\nnodes = 1\n", {"suture.radius_m=0.01"}),
            test::temp_folder() + "scene.toml:2: key 'suture.nodes': found 1, allowed integer 2 .. 5000")
      << "no override can be the cause";
}

TEST(SceneFile, LaysAPolylineOutAtRestLengthNextToTheSceneFile) {
  write("line.csv", "x,y,z\n0,0,0\n10,0,0\n");
  const auto read = load_scene(write("with_line.toml", "[suture]\nnodes = 3\nlength_m = 4\ninitial = \"line.csv\"\n"));
  ASSERT_TRUE(std::holds_alternative<Scene>(read)) << std::get<Error>(read).text;
  EXPECT_EQ(std::get<Scene>(read).suture.initial_polyline_m, (std::vector<Vec>{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}));
}

}  // namespace
}  // namespace ligature::scene
