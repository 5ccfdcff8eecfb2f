#include "evert/app/mesh_command.hpp"
#include "evert/mesh/generators.hpp"
#include "evert/mesh/mesh_reader.hpp"
#include "evert/mesh/mesh_writer.hpp"

#include "mesh_files.hpp"
#include <sstream>

namespace evert::test {
namespace {

class MeshCommand : public MeshFileTest {
 protected:
  /// Runs `evert mesh` with the words of `line`, '@' standing for the test's folder.
  [[nodiscard]] std::string run(const std::string& line) const {
    std::istringstream words(line);
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) {
      const auto at = word.find('@');
      arguments.push_back(at == std::string::npos ? word : path(word.substr(at + 1)).string());
    }
    std::ostringstream out;
    EXPECT_EQ(mesh_command(arguments, out), 0);
    return out.str();
  }
  void expect_refused(const std::string& line, std::initializer_list<std::string_view> fragments) const {
    expect_user_error([&] { static_cast<void>(run(line)); }, fragments);
  }
};

void expect_holds(const std::string& text, std::initializer_list<std::string_view> fragments) {
  for (const auto fragment : fragments)
    EXPECT_NE(text.find(fragment), std::string::npos) << fragment << "\n" << text;
}

TEST_F(MeshCommand, generates_every_shape_with_its_histogram) {
  for (const auto* line :
       {"generate box -size 1,0.5,0.5 -edge_length 0.25 -cell tet6 -o @box.msh",
        "generate box -size 1,0.5,0.5 -cells 2,1,1 -cell hex8 -o @box.vtu",
        "generate box -size 1,1,1 --cells 2,2,2 -o @bcc.mesh",
        "generate box -size 3,3,1 -cells 3,3,1 -hole 1,1 -cell hex8 -o @ring.vtu",
        "generate ball -radius 1 -edge_length 0.5 -o @ball.vtk",
        "generate torus -major_radius 0.5 -minor_radius 0.2 -edge_length 0.1 -o @torus.msh",
        "generate cylinder -radius 0.2 -length 1 -edge_length 0.1 -o @cylinder.msh",
        "generate capsule -radius 0.2 -length 1 -edge_length 0.1 -o @capsule.msh",
        "generate ellipsoid -radii 1,0.5,0.5 -edge_length 0.2 -o @ellipsoid.msh",
        "generate rounded_box -size 1,1,1 -rounding 0.2 -edge_length 0.2 -o @rounded.msh",
        "generate cone -bottom_radius 0.5 -length 1 -edge_length 0.2 -o @cone.msh",
        "generate gear -teeth 8 -root_radius 0.3 -tip_radius 0.5 -width 0.2 -edge_length 0.05 -o @gear.msh",
        "generate figure -edge_length 0.03 -o @figure.msh"}) {
    const auto text = run(line);
    expect_holds(text, {"dihedral angles", "%  #", "negative cells    0", "wrote "});
    EXPECT_GT(read_mesh(path(std::string(line).substr(std::string(line).find('@') + 1))).cell_count(), 0)
        << line;
  }
  EXPECT_EQ(read_mesh(path("box.vtu")).block(CellType::hex8)->size(), 2);
}

TEST_F(MeshCommand, converts_and_mends) {
  auto mesh = generate_box({1, 1, 1}, {2, 2, 2}, BoxCells::tet6);
  for (auto& node : mesh.nodes) node[0] = -node[0];
  mesh.nodes.push_back({9, 9, 9});
  write_mesh(mesh, path("in.msh"));
  expect_holds(run("convert @in.msh @same.vtu"), {"wrote ", "28 nodes, 48 cells"});
  expect_holds(run("quality @same.vtu"),
               {"negative cells    48  (evert mesh convert -reorient mends them)",
                "unused nodes      1  (evert mesh convert -drop_unused removes them)"});
  expect_holds(run("convert @in.msh @out.msh -reorient -drop_unused -gmsh22"),
               {"reoriented 48 cells", "dropped 1 unused nodes", "27 nodes"});
  EXPECT_TRUE(content_of(path("out.msh")).starts_with("$MeshFormat\n2.2 0 8"));
  expect_holds(run("quality @out.msh"), {"negative cells    0\n", "unused nodes      0\n"});
  expect_holds(run("convert @in.msh @out.mesh"), {"note: Medit has no names", "node sets are left out"});
}

TEST_F(MeshCommand, writes_quality_as_json) {
  write_mesh(generate_box({1, 1, 1}, {1, 1, 1}, BoxCells::tet5), path("box.msh"));
  expect_holds(run("quality @box.msh -json @box.json"), {"box.json"});
  expect_holds(content_of(path("box.json")), {"\"cells\": 5", "\"angle_histogram_by_10_degrees\": ["});
}

TEST_F(MeshCommand, partitions_and_shows_the_ranks) {
  write_mesh(generate_box({4, 1, 1}, {8, 2, 2}, BoxCells::hex8), path("box.msh"));
  expect_holds(run("partition @box.msh -ranks 2 -o @ranks.vtk"),
               {"neighbours", "     0          16", "edge cut 4 faces"});
  expect_holds(content_of(path("ranks.vtk")), {"SCALARS rank int 1"});
}

TEST_F(MeshCommand, explains_itself) {
  for (const auto* line : {"--help", "-h", "generate -help", "convert --help"})
    expect_holds(run(line), {"evert mesh generate", "Examples:", "-reorient", "-ranks"});
}

TEST_F(MeshCommand, refuses_wrong_usage) {
  write_mesh(generate_box({1, 1, 1}, {1, 1, 1}, BoxCells::tet5), path("box.msh"));
  const std::string box = "generate box -size 1,1,1 -edge_length 0.5 -o @b.msh ";
  expect_refused("", {"needs a command: generate, convert, quality or partition", "--help"});
  expect_refused("generat", {"there is no command 'generat'", "did you mean 'generate'?"});
  expect_refused("generate", {"needs a shape: box, ball, rounded_box, ellipsoid,",
                              "wedge_stack, cut_cube or sliver_ball"});
  expect_refused("generate torsu -o @t.msh", {"there is no shape 'torsu'", "did you mean 'torus'?"});
  expect_refused("generate ball -radius 1 -edge_length 0.5", {"evert mesh generate ball needs -o"});
  expect_refused("generate ball -edge_length 0.5 -o @b.msh",
                 {"evert mesh generate ball: 'radius' is missing [m]"});
  expect_refused("generate ball -raduis 1 -o @b.msh",
                 {"there is no option -raduis", "did you mean '-radius'?"});
  expect_refused("generate ball -radius 1 -radius 2 -o @b.msh", {"-radius is given twice"});
  expect_refused("generate ball -o @b.msh -edge_length 1 -radius", {"-radius needs a value"});
  expect_refused("generate ball -o @b.msh -edge_length 1 -radius 1m",
                 {"radius: '1m' has a unit: write the SI number alone [m]"});
  expect_refused("generate ball -o @b.msh -edge_length 1 -radius nan",
                 {"radius: 'nan' is not allowed: must be finite"});
  expect_refused("generate ball -o @b.msh -edge_length 1 -radius -1",
                 {"radius: '-1' is not allowed: must be > 0"});
  expect_refused("generate ball -o @b.msh -edge_length 0 -radius 1",
                 {"edge_length: '0' is not allowed: must be > 0"});
  expect_refused("generate ball -o @b.off -edge_length 1 -radius 1", {"b.off", "not '.off'"});
  expect_refused(box + "-cells 1,1,1", {"needs either 'cells' or 'edge_length'"});
  expect_refused(box + "-cell hex9", {"cell: 'hex9' is not allowed: must be bcc,", "did you mean 'hex8'?"});
  expect_refused("generate box -size 1,1 -edge_length 0.5 -o @b.msh",
                 {"size: must be a list of 3 numbers, not of 2"});
  expect_refused("generate box -size 1,1,1 -edge_length 0.5 -hole 1,1 -o @b.msh", {"hole: needs 'cells'"});
  expect_refused("generate box -size 1,1,1 -cells 2,2,2.5 -o @b.msh",
                 {"cells[2]: '2.5' is not allowed: must be a whole number"});
  expect_refused(box + "extra", {"'extra' is one argument too many"});
  expect_refused("convert", {"needs a mesh to read"});
  expect_refused("convert @box.msh", {"needs a file to write"});
  expect_refused("convert @box.msh @out.vtu -gmsh22", {"-gmsh22 is for .msh files only"});
  expect_refused("convert @missing.msh @out.vtu", {"missing.msh: there is no such file"});
  expect_refused("convert @box.msh @no/such/out.vtu", {"out.vtu: cannot be written"});
  expect_refused("quality @box.msh -json @no/such/q.json", {"q.json: cannot be written"});
  expect_refused("partition @box.msh", {"needs -ranks"});
  expect_refused("partition @box.msh -ranks 0", {"-ranks must be at least 1, not 0"});
  expect_refused("partition @box.msh -ranks two", {"-ranks must be a whole number, not 'two'"});
  expect_refused("partition @box.msh -ranks 6", {"5"});  // more ranks than cells
  expect_refused("partition @box.msh -ranks 2 -o @out.msh", {".vtk and .vtu files only"});
}

}  // namespace
}  // namespace evert::test
