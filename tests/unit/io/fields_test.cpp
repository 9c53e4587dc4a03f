/// Arrays of numbers on nodes and elements: read, kept, written again.

#include <cmath>
#include <limits>

#include "core/basis/node_ordering.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

using Place = FieldArray::Place;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

const FieldArray& named(const std::vector<FieldArray>& fields, const std::string& name, Place place = Place::nodes) {
    for (const FieldArray& field : fields)
        if (field.name == name && field.place == place) return field;
    ADD_FAILURE() << "there is no " << name;
    static const FieldArray none;
    return none;
}

/// NaN equals NaN.
void expect_same_values(const std::vector<double>& a, const std::vector<double>& b, const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))
            << what << " " << i << ": " << a[i] << " " << b[i];
}

/// A curved triangle with its sides and a corner, and arrays of several kinds.
std::vector<FieldArray> some_fields(const CurvedMesh& mesh) {
    const auto nodes = static_cast<std::size_t>(mesh.topology().node_count());
    std::vector<FieldArray> fields(5);
    fields[0].name = "pressure";
    for (std::size_t i = 0; i < nodes; ++i) fields[0].values.push_back(101325.0 + static_cast<double>(i) / 3.0);
    fields[1].name = "velocity of the \"wall\" & <more>";
    fields[1].components = 3;
    for (std::size_t i = 0; i < 3 * nodes; ++i) fields[1].values.push_back(std::sin(static_cast<double>(i)) * 1e-7);
    fields[2] = {"partition", Place::elements, 1, {7.0}, {1.0, 2.0, 3.0, 4.0}, true};
    fields[3] = {"stress", Place::elements, 9, {1, 2, 3, 4, 5, 6, 7, 8, 9.5}, {}, false};
    fields[4] = {"pressure", Place::elements, 1, {1e-300}, {}, false};
    return fields;
}

struct Target {
    std::string file;
    std::optional<MeshFormat> format;
    std::optional<bool> binary;
};

TEST(Fields, every_format_keeps_them) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 3});
    const std::vector<FieldArray> fields = some_fields(mesh);
    for (const Target& target :
         {Target{"a.vtu", {}, {}}, Target{"b.vtu", {}, false}, Target{"a.vtk", {}, {}}, Target{"b.vtk", {}, true},
          Target{"a.msh", {}, {}}, Target{"b.msh", MeshFormat::msh2, {}}}) {
        WriteOptions options;
        options.format = target.format;
        options.binary = target.binary;
        options.fields = &fields;
        EXPECT_TRUE(write_mesh(folder / target.file, mesh, options).empty()) << target.file;
        const ReadResult result = read_mesh(folder / target.file);
        EXPECT_TRUE(result.notes.empty()) << target.file << ": " << result.notes.front();
        ASSERT_EQ(result.fields.size(), fields.size()) << target.file;
        const bool is_msh = target.file.ends_with(".msh");
        for (const FieldArray& field : fields) {
            std::string name = field.name;  // MSH has no way to write a quotation mark in a name
            if (is_msh) std::replace(name.begin(), name.end(), '"', '\'');
            const FieldArray& back = named(result.fields, name, field.place);
            EXPECT_EQ(back.components, field.components) << target.file << " " << name;
            expect_same_values(back.values, field.values, target.file + " " + name);
            const bool is_integer = field.is_integer && !is_msh;
            EXPECT_EQ(back.is_integer, is_integer) << target.file << " " << name;
            if (!field.lower_values.empty())
                expect_same_values(back.lower_values, field.lower_values, target.file + " sides of " + name);
        }
    }
}

TEST(Fields, missing_values_stay_missing) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 2});
    std::vector<FieldArray> fields(1);
    fields[0].name = "p";
    fields[0].values = {1.5, missing, -2.0, missing, 0.0, 1e9};
    WriteOptions options;
    options.fields = &fields;
    for (const std::string file : {"a.vtu", "a.msh"}) {
        EXPECT_TRUE(write_mesh(folder / file, mesh, options).empty());
        expect_same_values(read_mesh(folder / file).fields.at(0).values, fields[0].values, file);
    }
    // Legacy VTK text has no word for it, and the writer says so.
    const auto notes = write_mesh(folder / "a.vtk", mesh, options);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("p, 2 values that are missing were written as 0"), std::string::npos) << notes[0];
    expect_same_values(read_mesh(folder / "a.vtk").fields.at(0).values, {1.5, 0.0, -2.0, 0.0, 0.0, 1e9}, "a.vtk");
    options.binary = true;
    EXPECT_TRUE(write_mesh(folder / "b.vtk", mesh, options).empty());
    expect_same_values(read_mesh(folder / "b.vtk").fields.at(0).values, fields[0].values, "b.vtk");
}

TEST(Fields, what_msh_has_no_rows_for_is_written_by_component) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 1});
    std::vector<FieldArray> fields(2);
    fields[0] = {"flat", Place::nodes, 2, {1, 2, 3, 4, 5, 6}, {}, false};
    fields[1] = {"strain", Place::elements, 6, {1, 2, 3, 4, 5, 6}, {}, false};
    WriteOptions options;
    options.fields = &fields;
    const auto notes = write_mesh(folder / "a.msh", mesh, options);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("strain has 6 components"), std::string::npos) << notes[0];
    const ReadResult result = read_mesh(folder / "a.msh");
    ASSERT_EQ(result.fields.size(), 7u);
    expect_same_values(named(result.fields, "flat").values, {1, 2, 0, 3, 4, 0, 5, 6, 0}, "flat");
    expect_same_values(named(result.fields, "strain 6", Place::elements).values, {6}, "strain");
}

TEST(Fields, this_programs_own_arrays_are_not_offered_twice) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 2});
    QualityReport report;
    report.elements.resize(1);
    const Coordinates reference = mesh.coordinates().array() - 0.5;
    std::vector<FieldArray> fields(2);
    fields[0] = {"ScaledJacobian", Place::elements, 1, {0.123}, {}, false};  // of another state: untrue by now
    fields[1] = {"Displacement", Place::nodes, 1, std::vector<double>(6, 9.0), {}, false};
    WriteOptions options;
    options.quality = &report;
    options.reference = &reference;
    options.fields = &fields;
    write_mesh(folder / "a.vtu", mesh, options);
    const ReadResult result = read_mesh(folder / "a.vtu");
    // How far nodes have moved cannot be computed from the file alone, so it is kept.
    ASSERT_EQ(result.fields.size(), 1u);
    EXPECT_EQ(result.fields[0].name, "Displacement");
    EXPECT_EQ(result.fields[0].components, 3);
    EXPECT_NEAR(result.fields[0].values[0], 0.5, 1e-15);
    write_mesh(folder / "a.msh", mesh, options);
    EXPECT_TRUE(read_mesh(folder / "a.msh").fields.empty());
    // Without them it is somebody else's array.
    WriteOptions plain;
    plain.fields = &fields;
    write_mesh(folder / "b.msh", mesh, plain);
    EXPECT_EQ(read_mesh(folder / "b.msh").fields.size(), 2u);
}

TEST(Fields, do_not_fit_another_mesh) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 2});
    std::vector<FieldArray> fields(1);
    fields[0] = {"p", Place::nodes, 1, {1, 2, 3}, {}, false};
    WriteOptions options;
    options.fields = &fields;
    for (const std::string file : {"a.vtu", "a.vtk", "a.msh"}) {
        EXPECT_NE(message_of<InvalidInput>([&] { write_mesh(folder / file, mesh, options); }).find("array p"),
                  std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(folder / file));
    }
}

// ------------------------------------------------------------------------------------------------- files of others

const std::string head =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"  // 1-9
    "$Elements\n2\n1 1 2 0 1 1 2\n2 2 2 0 1 1 2 3\n$EndElements\n";                            // 10-14

std::string node_data(const std::string& rows, const std::string& name = "p", int step = 0, int components = 1,
                      int count = -1) {
    if (count < 0) count = static_cast<int>(std::count(rows.begin(), rows.end(), '\n'));
    return "$NodeData\n1\n\"" + name + "\"\n1\n0.5\n3\n" + std::to_string(step) + "\n" + std::to_string(components) +
           "\n" + std::to_string(count) + "\n" + rows + "$EndNodeData\n";
}

TEST(Fields, of_gmsh_are_read_by_tag) {
    const TemporaryFolder folder;
    const ReadResult result = read_mesh(folder.write(
        "a.msh", head + node_data("3 30\n1 10\n") +
                     "$ElementData\n2\n\"k\"\n\"scheme\"\n1\n0\n4\n0\n1\n2\n1\n1 -1\n2 5\n$EndElementData\n" +
                     "$ElementNodeData\n1\n\"q\"\n1\n0\n3\n0\n1\n1\n2 3 1 2 3\n$EndElementNodeData\n"));
    ASSERT_EQ(result.fields.size(), 2u);
    expect_same_values(named(result.fields, "p").values, {10, missing, 30}, "p");
    EXPECT_EQ(named(result.fields, "p").time, 0.5);
    expect_same_values(named(result.fields, "k", Place::elements).values, {5}, "k");
    expect_same_values(named(result.fields, "k", Place::elements).lower_values, {-1}, "k of the line");
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.notes[0], "Section $ElementNodeData was skipped.");
}

TEST(Fields, values_of_strangers_are_passed_over_with_a_note) {
    const TemporaryFolder folder;
    const ReadResult result = read_mesh(folder.write("a.msh", head + node_data("3 30\n8 1\n9 1\n2 nan\n")));
    expect_same_values(result.fields.at(0).values, {missing, missing, 30}, "p");
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.notes[0],
              "Line 15: $NodeData \"p\" has values of 2 nodes that the mesh does not have; they were passed over.");
}

TEST(Fields, sections_of_one_name) {
    const TemporaryFolder folder;
    // Two time steps: two arrays.
    ReadResult result =
        read_mesh(folder.write("a.msh", head + node_data("1 1\n", "p", 0) + node_data("1 2\n2 2\n", "p", 7)));
    ASSERT_EQ(result.fields.size(), 2u);
    EXPECT_EQ(named(result.fields, "p, step 0").values[0], 1.0);
    EXPECT_EQ(named(result.fields, "p, step 7").time_step, 7);
    // Parts of a partitioned mesh: one array.
    result = read_mesh(folder.write("a.msh", head + node_data("1 1\n") + node_data("2 2\n3 3\n")));
    ASSERT_EQ(result.fields.size(), 1u);
    expect_same_values(result.fields[0].values, {1, 2, 3}, "p");
    // The same nodes twice: two arrays that can be told apart.
    result = read_mesh(folder.write("a.msh", head + node_data("1 1\n") + node_data("1 2\n")));
    ASSERT_EQ(result.fields.size(), 2u);
    EXPECT_EQ(named(result.fields, "p (2)").values[0], 2.0);
    EXPECT_EQ(result.notes.size(), 1u);
    // They may stand before the mesh.
    const std::size_t nodes = head.find("$Nodes");
    result = read_mesh(folder.write("a.msh", head.substr(0, nodes) + node_data("2 4\n") + head.substr(nodes)));
    expect_same_values(result.fields.at(0).values, {missing, 4, missing}, "p");
}

TEST(Fields, hostile_msh_is_told_with_line_and_reason) {
    const TemporaryFolder folder;
    const struct {
        const char* what;
        std::string text, expected;
    } table[] = {
        {"more values than rows", head + node_data("1 1\n", "p", 0, 1, 2),
         ":25: \"$EndNodeData\" stands where a node tag"},
        {"fewer values than rows", head + node_data("1 1\n2 2\n", "p", 0, 1, 1),
         ":25: \"2\" stands where $EndNodeData"},
        {"huge count", head + node_data("1 1\n", "p", 0, 1, 2000000000), "2000000000 values are announced"},
        {"huge number of components", head + node_data("1 1\n", "p", 0, 2000000000), ":22: the data have 2000000000"},
        {"no component", head + node_data("1 1\n", "p", 0, 0), "the data have 0 components"},
        {"negative count", head + "$NodeData\n1\n\"p\"\n0\n3\n0\n1\n-5\n", ":22: the number of values is -5"},
        {"name without marks", head + "$NodeData\n1\np\n0\n3\n0\n1\n0\n$EndNodeData\n",
         ":17: \"p\" stands where the name of the data in quotation marks"},
        {"name without end", head + "$NodeData\n1\n\"p\n0\n3\n0\n1\n0\n$EndNodeData\n", ":17:"},
        {"too few integers", head + "$NodeData\n1\n\"p\"\n0\n2\n0\n1\n$EndNodeData\n", "the data have 2 integer tags"},
        {"a word for a value", head + node_data("1 one\n"), ":24: \"one\" stands where a value (a number)"},
        {"a tag with a fraction", head + node_data("1.5 1\n"), "\"1.5\" stands where a node tag"},
        {"no end", head + "$ElementData\n1\n\"p\"\n0\n3\n0\n1\n1\n2 1\n", "the file ends where $EndElementData"},
        {"cut within", head + "$ElementData\n1\n\"p\"\n0\n3\n0\n", ":19: 3 integer tags of the data are announced"},
        {"wrong end", head + "$NodeData\n1\n\"p\"\n0\n3\n0\n1\n0\n$EndElementData\n",
         "\"$EndElementData\" stands where $EndNodeData"},
        {"huge number of names", head + "$NodeData\n900000000\n\"p\"\n", "900000000 string tags"},
    };
    for (const auto& row : table) {
        const auto file = folder.write("bad.msh", row.text);
        const std::string message = message_of<InvalidInput>([&] { read_mesh(file); });
        EXPECT_NE(message.find(row.expected), std::string::npos) << row.what << ": " << message;
        EXPECT_NE(message.find("bad.msh:"), std::string::npos) << row.what << ": " << message;
    }
}

const std::string legacy =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n"  // 1-5
    "0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";                              // 6-10

TEST(Fields, of_legacy_vtk_in_all_its_words) {
    const TemporaryFolder folder;
    const ReadResult result = read_mesh(
        folder.write("a.vtk", legacy + "POINT_DATA 3\nSCALARS p int 1\nLOOKUP_TABLE default\n1 2 3\nVECTORS v float\n"
                                       "1 0 0 0 1 0 0 0 1\nFIELD more 1\nq 2 3 double\n1 2 3 4 5 6\n"
                                       "CELL_DATA 1\nSCALARS k double\nLOOKUP_TABLE default\n0.5\n"));
    EXPECT_TRUE(result.notes.empty());
    ASSERT_EQ(result.fields.size(), 4u);
    expect_same_values(named(result.fields, "p").values, {1, 2, 3}, "p");
    EXPECT_TRUE(named(result.fields, "p").is_integer);
    EXPECT_EQ(named(result.fields, "v").components, 3);
    expect_same_values(named(result.fields, "q").values, {1, 2, 3, 4, 5, 6}, "q");
    expect_same_values(named(result.fields, "k", Place::elements).values, {0.5}, "k");
}

TEST(Fields, hostile_vtk_is_told) {
    const TemporaryFolder folder;
    const struct {
        const char* what;
        std::string text, expected;
    } table[] = {
        {"too few values", legacy + "POINT_DATA 3\nSCALARS p double\nLOOKUP_TABLE default\n1 2\n",
         "the file ends where"},
        {"wrong number of points", legacy + "POINT_DATA 4\nSCALARS p double\nLOOKUP_TABLE default\n1 2 3 4\n",
         "bad.vtk:11: the data are announced for 4 points, but there are 3"},
        {"huge number of points", legacy + "POINT_DATA 99999999999\n", "99999999999 rows of the data are announced"},
        {"huge field", legacy + "CELL_DATA 1\nFIELD f 1\np 2000000000 1 double\n1\n", "bad.vtk:13: 2000000000"},
        {"rows of a field", legacy + "CELL_DATA 1\nFIELD f 1\np 1 7 double\n1\n", "bad.vtk:13: an array has 7 rows"},
        {"unknown type", legacy + "POINT_DATA 3\nSCALARS p complex\n", "bad.vtk:12: the type of an array"},
        {"nan", legacy + "POINT_DATA 3\nSCALARS p double\nLOOKUP_TABLE default\n1 nan 2\n", "bad.vtk:14: \"nan\""},
        {"components are a word", legacy + "POINT_DATA 3\nSCALARS p double many\n", "\"many\" stands where"},
    };
    for (const auto& row : table) {
        const auto file = folder.write("bad.vtk", row.text);
        const std::string message = message_of<InvalidInput>([&] { read_mesh(file); });
        EXPECT_NE(message.find(row.expected), std::string::npos) << row.what << ": " << message;
    }
    const auto vtu = [&](const std::string& array) {
        return folder.write(
            "bad.vtu",
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" "
            "NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 "
            "0 "
            "0 0 1 0</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 "
            "2</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3</DataArray><DataArray "
            "type=\"UInt8\" Name=\"types\" format=\"ascii\">5</DataArray></Cells><PointData>" +
                array + "</PointData></Piece></UnstructuredGrid></VTKFile>");
    };
    ReadResult result =
        read_mesh(vtu("<DataArray type=\"Float32\" Name=\"T\" format=\"ascii\">1.5 2 nan </DataArray>"));
    ASSERT_EQ(result.fields.size(), 1u);
    expect_same_values(result.fields[0].values, {1.5, 2, missing}, "T");
    for (const char* number : {"-3", "99999999999", "x"})
        EXPECT_NE(message_of<InvalidInput>([&] {
                      read_mesh(vtu(std::string("<DataArray type=\"Float32\" Name=\"T\" NumberOfComponents=\"") +
                                    number + "\" format=\"ascii\">1 2 3</DataArray>"));
                  }).find("components"),
                  std::string::npos)
            << number;
    EXPECT_THROW(read_mesh(vtu("<DataArray type=\"Float32\" Name=\"T\" format=\"ascii\">1 2</DataArray>")),
                 InvalidInput);
    // Texts are nothing to colour by.
    result = read_mesh(vtu("<Array type=\"String\" Name=\"words\" format=\"ascii\">97 0 98 0 99 0</Array>"));
    EXPECT_TRUE(result.fields.empty());
}

TEST(Fields, scalars_of_rows) {
    const std::vector<double> rows = {3, 4, 0, missing, 1, 2};
    expect_same_values(scalar_values(rows, 3, -1), {5, missing}, "length");
    expect_same_values(scalar_values(rows, 3, 1), {4, 1}, "y");
    expect_same_values(scalar_values(rows, 1, -1), rows, "numbers");
    EXPECT_EQ(finite_range(rows), (std::pair{0.0, 4.0}));
    EXPECT_EQ(finite_range(std::vector<double>{missing, INFINITY}), std::nullopt);
}

}  // namespace
}  // namespace curvewright
