#include <random>

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/vtk_io.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const std::filesystem::path& file) {
    if (file.extension() == ".vtu") {
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->SetFileName(file.c_str());
        reader->Update();
        return reader->GetOutput();
    }
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
}

/// A grid of one cell whose points lie where VTK says that the cell's parametric coordinates are.
vtkSmartPointer<vtkUnstructuredGrid> foreign_grid(int cell_type, int points) {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkGenericCell> cell;
    cell->SetCellType(cell_type);
    const double* parametric = cell->GetParametricCoords();
    vtkNew<vtkPoints> positions;
    std::vector<vtkIdType> ids;
    for (int i = 0; i < points; ++i) ids.push_back(positions->InsertNextPoint(parametric + 3 * i));
    grid->SetPoints(positions);  // Float32
    grid->InsertNextCell(cell_type, points, ids.data());
    return grid;
}

void write_with_vtk(const std::filesystem::path& file, vtkUnstructuredGrid* grid, int mode) {
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetInputData(grid);
    writer->SetDataMode(mode);
    ASSERT_EQ(writer->Write(), 1);
}

TEST(Vtk, cells_have_the_types_and_the_geometry_that_vtk_gives_them) {
    const TemporaryFolder folder;
    const std::vector<std::pair<Shape, std::array<int, 2>>> types = {
        {Shape::line, {VTK_LINE, VTK_LAGRANGE_CURVE}},
        {Shape::triangle, {VTK_TRIANGLE, VTK_LAGRANGE_TRIANGLE}},
        {Shape::quadrilateral, {VTK_QUAD, VTK_LAGRANGE_QUADRILATERAL}},
        {Shape::tetrahedron, {VTK_TETRA, VTK_LAGRANGE_TETRAHEDRON}},
        {Shape::hexahedron, {VTK_HEXAHEDRON, VTK_LAGRANGE_HEXAHEDRON}},
        {Shape::prism, {VTK_WEDGE, VTK_LAGRANGE_WEDGE}},
    };
    for (const auto& [shape, vtk_types] : types)
        for (int order = 1; order <= 4; ++order) {
            const CurvedMesh mesh = one_element_mesh({shape, order});
            write_mesh(folder / "a.vtu", mesh);
            const auto grid = read_with_vtk(folder / "a.vtu");
            const vtkIdType last = grid->GetNumberOfCells() - 1;
            EXPECT_EQ(grid->GetCellType(last), vtk_types[order == 1 ? 0 : 1]) << name(shape);
            // VTK's parametric coordinates of node i are our lattice point i, so the two interpolate alike.
            vtkNew<vtkGenericCell> cell;
            grid->GetCell(last, cell);
            const double* parametric = cell->GetParametricCoords();
            const auto& lattice = reference_element({shape, order}).lattice;
            if (shape == Shape::prism && order == 1) continue;  // see vtk_order_test
            for (std::size_t i = 0; i < lattice.size(); ++i)
                for (int d = 0; d < dimension(shape); ++d)
                    EXPECT_NEAR(parametric[3 * i + d], static_cast<double>(lattice[i][d]) / order, 1e-12)
                        << name(ElementType{shape, order}) << " node " << i;
        }
}

TEST(Vtk, quality_and_displacement_stand_in_the_file) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 2});
    QualityReport report;
    report.elements.resize(1);
    report.elements[0].scaled_jacobian = 0.123456789012345678;
    report.elements[0].validity = Validity::undecided;
    const Coordinates reference = mesh.coordinates().array() - 0.5;
    WriteOptions options;
    options.quality = &report;
    options.reference = &reference;
    for (const auto& [file, binary, is_nan] : {std::tuple{"a.vtu", true, true}, std::tuple{"b.vtu", false, true},
                                               std::tuple{"a.vtk", true, true}, std::tuple{"b.vtk", false, false}}) {
        options.binary = binary;
        write_mesh(folder / file, mesh, options);
        const auto grid = read_with_vtk(folder / file);
        ASSERT_EQ(grid->GetNumberOfCells(), 5);
        vtkDataArray* jacobian = grid->GetCellData()->GetArray("ScaledJacobian");
        vtkDataArray* validity = grid->GetCellData()->GetArray("Validity");
        vtkDataArray* displacement = grid->GetPointData()->GetArray("Displacement");
        ASSERT_TRUE(jacobian && validity && displacement) << file;
        EXPECT_EQ(jacobian->GetTuple1(4), 0.123456789012345678) << file;
        EXPECT_EQ(validity->GetTuple1(4), 2) << file;
        EXPECT_EQ(validity->GetTuple1(0), -1) << file;
        if (is_nan)
            EXPECT_TRUE(std::isnan(jacobian->GetTuple1(0))) << file;
        else
            EXPECT_EQ(jacobian->GetTuple1(0), 1.0) << file;
        EXPECT_NEAR(displacement->GetComponent(3, 1), 0.5, 1e-15) << file;
        EXPECT_EQ(grid->GetCellData()->GetArray("PhysicalGroup")->GetTuple1(4), 1) << file;
        EXPECT_EQ(grid->GetPointData()->GetArray("NodeTag")->GetDataType(), VTK_TYPE_INT64) << file;
        expect_same_model(mesh, read_mesh(folder / file).mesh, file);
    }
    report.elements.resize(2);
    EXPECT_THROW(write_mesh(folder / "c.vtu", mesh, options), InvalidInput);
    EXPECT_FALSE(std::filesystem::exists(folder / "c.vtu"));
}

TEST(Vtk, foreign_cells_are_read_by_their_parametric_coordinates) {
    const TemporaryFolder folder;
    for (const auto& [vtk_type, type] : std::vector<std::pair<int, ElementType>>{
             {VTK_QUADRATIC_EDGE, {Shape::line, 2}},
             {VTK_QUADRATIC_TRIANGLE, {Shape::triangle, 2}},
             {VTK_BIQUADRATIC_QUAD, {Shape::quadrilateral, 2}},
             {VTK_QUADRATIC_TETRA, {Shape::tetrahedron, 2}},
             {VTK_TRIQUADRATIC_HEXAHEDRON, {Shape::hexahedron, 2}},
             {VTK_BIQUADRATIC_QUADRATIC_WEDGE, {Shape::prism, 2}},
             {VTK_VOXEL, {Shape::hexahedron, 1}},
             {VTK_PIXEL, {Shape::quadrilateral, 1}},
         })
        for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
            write_with_vtk(folder / "a.vtu", foreign_grid(vtk_type, node_count(type)), mode);
            const ReadResult result = read_mesh(folder / "a.vtu");
            ASSERT_EQ(result.mesh.topology().uniform_type(), type) << vtk_type;
            EXPECT_TRUE(result.mesh.topology().groups().empty());
            EXPECT_EQ(result.mesh.topology().node_tag(0).value, 1);
            EXPECT_EQ(result.mesh.topology().element_tag(0).value, 1);
            const auto& lattice = reference_element(type).lattice;
            const auto x = result.mesh.element_coordinates(0);
            for (std::size_t i = 0; i < lattice.size(); ++i)
                for (int d = 0; d < 3; ++d)
                    EXPECT_EQ(x(static_cast<Eigen::Index>(i), d) * type.order, lattice[i][d]) << vtk_type;
        }
}

TEST(Vtk, cells_that_are_not_supported_are_told_by_name) {
    const TemporaryFolder folder;
    for (const auto& [vtk_type, points, expected] :
         {std::tuple{VTK_QUADRATIC_HEXAHEDRON, 20, "vtkQuadraticHexahedron (VTK type 25) with 20 points"},
          std::tuple{VTK_QUADRATIC_QUAD, 8, "vtkQuadraticQuad (VTK type 23)"}}) {
        write_with_vtk(folder / "a.vtu", foreign_grid(vtk_type, points), vtkXMLWriter::Ascii);
        const std::string message = message_of<Unsupported>([&] { read_mesh(folder / "a.vtu"); });
        EXPECT_NE(message.find(expected), std::string::npos) << message;
    }
}

TEST(Vtk, tetrahedra_in_the_order_of_gmsh_are_noticed) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = read_mesh(test_data("box_p3.msh")).mesh;
    ASSERT_EQ(mesh.topology().uniform_type(), (ElementType{Shape::tetrahedron, 3}));
    for (const bool is_permuted : {false, true}) {
        vtkNew<vtkUnstructuredGrid> grid;
        vtkNew<vtkPoints> points;
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            points->InsertNextPoint(mesh.coordinates().row(node).data());
        grid->SetPoints(points);
        for (Index element = 0; element < mesh.topology().element_count(); ++element) {
            const auto nodes = mesh.topology().element_nodes(element);
            const auto& permutation = gmsh_permutation({Shape::tetrahedron, 3});
            std::vector<vtkIdType> ids(nodes.begin(), nodes.end());
            for (std::size_t i = 0; is_permuted && i < ids.size(); ++i)
                ids[static_cast<std::size_t>(permutation[i])] = nodes[i];
            grid->InsertNextCell(VTK_LAGRANGE_TETRAHEDRON, static_cast<vtkIdType>(ids.size()), ids.data());
        }
        vtkNew<vtkUnstructuredGridWriter> writer;
        writer->SetFileName((folder / "a.vtk").c_str());
        writer->SetInputData(grid);
        ASSERT_EQ(writer->Write(), 1);
        const ReadResult result = read_mesh(folder / "a.vtk");
        EXPECT_EQ(result.notes.size(), is_permuted ? 1u : 0u);
        if (is_permuted) {
            EXPECT_NE(result.notes.front().find("Gmsh's order"), std::string::npos);
        }
    }
}

TEST(Vtk, reads_what_gmsh_exports) {
    const CurvedMesh mesh = read_mesh(test_data("box_p3.msh")).mesh;
    const ReadResult exported = read_mesh(test_data("box_p3_gmsh.vtk"));
    ASSERT_EQ(exported.mesh.topology().uniform_type(), (ElementType{Shape::tetrahedron, 3}));
    ASSERT_EQ(exported.notes.size(), 1u);
    EXPECT_NE(exported.notes.front().find("Gmsh"), std::string::npos);
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        EXPECT_LT((mesh.element_coordinates(element) - exported.mesh.element_coordinates(element)).norm(), 1e-12);
}

TEST(Vtk, damaged_files_give_one_sentence_and_nothing_on_the_terminal) {
    const TemporaryFolder folder;
    write_mesh(folder / "a.vtu", one_element_mesh({Shape::tetrahedron, 2}));
    write_mesh(folder / "a.vtk", one_element_mesh({Shape::tetrahedron, 2}));
    testing::internal::CaptureStderr();
    for (const char* name : {"a.vtu", "a.vtk"}) {
        const std::string text = read_text_file(folder / name);
        for (const double fraction : {0.3, 0.6, 0.9}) {
            const auto cut = text.substr(0, static_cast<std::size_t>(fraction * static_cast<double>(text.size())));
            const auto file = folder.write(std::string("cut") + name, cut);
            const std::string message = message_of<Error>([&] { read_mesh(file); });
            EXPECT_NE(message.find("cuta.vt"), std::string::npos) << name << " " << fraction << ": " << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THROW(read_mesh(folder.write("b.vtu", "<VTKFile type=\"PolyData\"></VTKFile>")), InvalidInput);
    EXPECT_THROW(read_mesh(folder.write("b.vtk", "hello")), InvalidInput);
}

TEST(Vtk, cells_that_point_nowhere_are_refused) {
    const TemporaryFolder folder;
    const auto vtu = [&](const char* connectivity, const char* offsets) {
        return folder.write(
            "a.vtu",
            std::string("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid>"
                        "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
                        "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Cells>"
                        "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">") +
                connectivity + "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + offsets +
                "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5</DataArray></Cells>"
                "</Piece></UnstructuredGrid></VTKFile>");
    };
    EXPECT_EQ(read_mesh(vtu("0 1 2", "3")).mesh.topology().element_count(), 1);
    EXPECT_THROW(read_mesh(vtu("0 1 7", "3")), InvalidInput);
    EXPECT_THROW(read_mesh(vtu("0 1 -1", "3")), InvalidInput);
    EXPECT_THROW(read_mesh(vtu("0 1 2", "9")), InvalidInput);
    EXPECT_THROW(read_mesh(vtu("0 1 1", "3")), InvalidInput);
}

TEST(Vtk, damaged_tags_are_replaced_with_a_note) {
    const TemporaryFolder folder;
    auto grid = foreign_grid(VTK_TRIANGLE, 3);
    vtkNew<vtkFloatArray> tags;
    tags->SetName("NodeTag");
    for (const float tag : {4.0f, 4.0f, 9.0f}) tags->InsertNextValue(tag);
    grid->GetPointData()->AddArray(tags);
    write_with_vtk(folder / "a.vtu", grid, vtkXMLWriter::Appended);
    const ReadResult result = read_mesh(folder / "a.vtu");
    EXPECT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.mesh.topology().node_tag(1).value, 2);
}

}  // namespace
}  // namespace curvewright
