#include <random>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellSizeFilter.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
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
#include "core/basis/lagrange.h"
#include "core/io/atomic_file.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> output_of(const std::filesystem::path& file) {
    vtkNew<Reader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const std::filesystem::path& file) {
    return file.extension() == ".vtu" ? output_of<vtkXMLUnstructuredGridReader>(file)
                                      : output_of<vtkUnstructuredGridReader>(file);
}

/// Lengths, areas or volumes of all cells as VTK measures them; those of volumes have a sign.
std::vector<double> sizes(vtkUnstructuredGrid* grid) {
    vtkNew<vtkCellSizeFilter> filter;
    filter->SetInputData(grid);
    filter->Update();
    auto* data = vtkUnstructuredGrid::SafeDownCast(filter->GetOutput())->GetCellData();
    std::vector<double> result;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
        const int dim = grid->GetCell(cell)->GetCellDimension();
        const char* name = dim == 3 ? "Volume" : dim == 2 ? "Area" : dim == 1 ? "Length" : "VertexCount";
        result.push_back(data->GetArray(name)->GetTuple1(cell));
    }
    return result;
}

/// The unit reference element, or a part of the unit cube, with nothing bent.
CurvedMesh straight_mesh(ElementType type) {
    return single_element(type, reference_nodes(type));
}

double reference_size(Shape shape) {
    switch (shape) {
        case Shape::triangle:
        case Shape::prism:
            return 1.0 / 2.0;
        case Shape::tetrahedron:
            return 1.0 / 6.0;
        case Shape::pyramid:
            return 1.0 / 3.0;
        default:
            return 1.0;
    }
}

TEST(VtkOrder, what_is_written_has_the_size_and_sign_that_vtk_measures) {
    const TemporaryFolder folder;
    for (const Shape shape : {Shape::line, Shape::triangle, Shape::quadrilateral, Shape::tetrahedron, Shape::hexahedron,
                              Shape::prism, Shape::pyramid})
        for (int order = 1; order <= (shape == Shape::pyramid ? 1 : 4); ++order)
            for (const char* file : {"a.vtu", "a.vtk"}) {
                write_mesh(folder / file, straight_mesh({shape, order}));
                const auto grid = read_with_vtk(folder / file);
                ASSERT_EQ(grid->GetNumberOfCells(), 1);
                EXPECT_NEAR(sizes(grid).front(), reference_size(shape), 1e-12) << name(ElementType{shape, order});
            }
}

TEST(VtkOrder, meshes_of_prisms_fill_the_cube_for_vtk) {
    const TemporaryFolder folder;
    for (const auto& [mesh, cells] : {std::pair{prism_mesh(2, 1), 16}, std::pair{prism_mesh(2, 3), 16},
                                      std::pair{mixed_cube_mesh(2, 1), 12}, std::pair{mixed_cube_mesh(2, 2), 12}})
        for (const char* file : {"a.vtu", "a.vtk"}) {
            write_mesh(folder / file, mesh);
            const auto grid = read_with_vtk(folder / file);
            double volume = 0.0;
            long solids = 0;
            const std::vector<double> all = sizes(grid);
            for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
                if (grid->GetCell(cell)->GetCellDimension() < 3) continue;
                EXPECT_GT(all[static_cast<std::size_t>(cell)], 0.0) << cell;
                volume += all[static_cast<std::size_t>(cell)];
                ++solids;
            }
            EXPECT_EQ(solids, cells);
            EXPECT_NEAR(volume, 1.0, 1e-12);
            expect_same_mesh(mesh, read_mesh(folder / file).mesh, file);
        }
}

/// A grid of one cell whose points lie where VTK says that the cell's parametric coordinates are, mirrored or not.
vtkSmartPointer<vtkUnstructuredGrid> foreign_grid(int cell_type, int points, bool is_mirrored) {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkGenericCell> cell;
    cell->SetCellType(cell_type);
    const double* parametric = cell->GetParametricCoords();
    vtkNew<vtkPoints> positions;
    positions->SetDataTypeToDouble();
    std::vector<vtkIdType> ids;
    for (int i = 0; i < points; ++i) {
        const double* x = parametric + 3 * i;
        ids.push_back(is_mirrored ? positions->InsertNextPoint(x[1], x[0], x[2]) : positions->InsertNextPoint(x));
    }
    grid->SetPoints(positions);
    grid->InsertNextCell(cell_type, points, ids.data());
    return grid;
}

/// Sum of J over the elements at the middle of their reference elements would do; the corners' edges do, too.
double corner_volume(const CurvedMesh& mesh) {
    const auto x = mesh.element_coordinates(0);
    const Shape shape = mesh.topology().element_type(0).shape;
    const bool is_square = shape == Shape::hexahedron || shape == Shape::pyramid;
    Eigen::Matrix3d edges;
    edges << x.row(1) - x.row(0), x.row(is_square ? 3 : 2) - x.row(0), x.row(is_square ? 4 : 3) - x.row(0);
    return edges.determinant();
}

TEST(VtkOrder, what_vtk_measures_is_what_is_read) {
    const TemporaryFolder folder;
    for (const auto& [vtk_type, points] :
         {std::pair{VTK_TETRA, 4}, std::pair{VTK_HEXAHEDRON, 8}, std::pair{VTK_WEDGE, 6}, std::pair{VTK_PYRAMID, 5},
          std::pair{VTK_QUADRATIC_TETRA, 10}})
        for (const bool is_mirrored : {false, true}) {
            const auto grid = foreign_grid(vtk_type, points, is_mirrored);
            vtkNew<vtkXMLUnstructuredGridWriter> writer;
            writer->SetFileName((folder / "a.vtu").c_str());
            writer->SetInputData(grid);
            ASSERT_EQ(writer->Write(), 1);
            vtkNew<vtkUnstructuredGridWriter> legacy;
            legacy->SetFileName((folder / "a.vtk").c_str());
            legacy->SetInputData(grid);
            ASSERT_EQ(legacy->Write(), 1);
            for (const char* file : {"a.vtu", "a.vtk"}) {
                const ReadResult result = read_mesh(folder / file);
                EXPECT_TRUE(result.notes.empty());
                EXPECT_GT(corner_volume(result.mesh) * sizes(grid).front(), 0.0) << vtk_type << " " << is_mirrored;
            }
        }
}

TEST(VtkOrder, quadratic_prisms_are_read_as_gmsh_and_meshio_write_them) {
    // vtkCellSizeFilter is no witness here: it measures 1/12 instead of 1/2 for vtkBiQuadraticQuadraticWedge.
    const TemporaryFolder folder;
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName((folder / "a.vtu").c_str());
    writer->SetInputData(foreign_grid(VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18, false));
    ASSERT_EQ(writer->Write(), 1);
    EXPECT_GT(corner_volume(read_mesh(folder / "a.vtu").mesh), 0.0);
}

TEST(VtkOrder, a_way_through_vtk_keeps_the_order_of_nodes) {
    const TemporaryFolder folder;
    for (const int order : {1, 2}) {
        const CurvedMesh mesh = one_element_mesh({Shape::prism, order});
        for (const char* between : {"b.vtu", "b.vtk"}) {
            write_mesh(folder / "a.msh", mesh);
            write_mesh(folder / between, read_mesh(folder / "a.msh").mesh);
            write_mesh(folder / "c.msh", read_mesh(folder / between).mesh);
            EXPECT_EQ(read_text_file(folder / "a.msh"), read_text_file(folder / "c.msh")) << between << " " << order;
        }
    }
}

TEST(VtkOrder, prisms_of_earlier_versions_are_told_apart) {
    const TemporaryFolder folder;
    for (const char* name : {"prisms_format1.vtu", "prisms_format1.vtk"}) {
        const ReadResult old = read_mesh(test_data(name));
        ASSERT_EQ(old.notes.size(), 1u) << name;
        EXPECT_NE(old.notes.front().find("2 linear prisms"), std::string::npos) << old.notes.front();
        const auto elements = elements_of(old.mesh);
        EXPECT_EQ(std::get<2>(elements.at({3, 3})), (std::vector<std::int64_t>{1, 2, 3, 5, 6, 7}));
        EXPECT_EQ(std::get<2>(elements.at({3, 4})), (std::vector<std::int64_t>{1, 3, 4, 5, 7, 8}));
        EXPECT_EQ(groups_of(old.mesh),
                  (std::set<std::tuple<int, int, std::string>>{{2, 3, "grund & boden"}, {3, 1, "body"}}));
        // Written again they are what VTK expects, and nothing needs to be said.
        write_mesh(folder / name, old.mesh);
        const ReadResult present = read_mesh(folder / name);
        EXPECT_TRUE(present.notes.empty());
        expect_same_model(old.mesh, present.mesh, name);
        for (const double size : sizes(read_with_vtk(folder / name))) EXPECT_GT(size, 0.0);
    }
}

TEST(VtkOrder, a_file_that_lost_its_version_is_read_right_all_the_same) {
    const TemporaryFolder folder;
    for (const bool is_clockwise : {false, true}) {
        CurvedMesh mesh = read_mesh(test_data("prisms_format1.vtu")).mesh;
        if (is_clockwise) mesh = flip_orientation(mesh);
        write_mesh(folder / "a.vtu", mesh);
        const auto grid = read_with_vtk(folder / "a.vtu");
        ASSERT_TRUE(grid->GetFieldData()->HasArray("CurvewrightFormat"));
        grid->GetFieldData()->RemoveArray("CurvewrightFormat");
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetFileName((folder / "b.vtu").c_str());
        writer->SetInputData(grid);
        ASSERT_EQ(writer->Write(), 1);
        const ReadResult result = read_mesh(folder / "b.vtu");
        EXPECT_TRUE(result.notes.empty());
        expect_same_model(mesh, result.mesh, is_clockwise ? "clockwise" : "");
    }
}

/// The file of one piece per mesh, in the version given; Lagrange hexahedra of versions before 2.1 in VTK 8's order.
std::string hexahedra_of_version(const std::vector<CurvedMesh>& pieces, const std::string& version) {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"" + version +
                       "\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n";
    for (const CurvedMesh& mesh : pieces) {
        const Index nodes = mesh.topology().node_count(), cells = mesh.topology().element_count();
        const int order = mesh.topology().order(), per_cell = node_count({Shape::hexahedron, order});
        std::string points, connectivity, offsets, types;
        for (Index node = 0; node < nodes; ++node)
            for (int d = 0; d < 3; ++d) points += fmt::format("{} ", mesh.coordinates()(node, d));
        for (Index cell = 0; cell < cells; ++cell) {
            const auto ids = mesh.topology().element_nodes(cell);
            for (int i = 0; i < per_cell; ++i) {
                int place = i;
                const int edge = 8 + 10 * (order - 1);  // the last but one of the twelve
                const bool is_old = version == "0.1" || version == "1.0" || version == "2.0";
                if (is_old && i >= edge && i < edge + 2 * (order - 1))
                    place = i < edge + (order - 1) ? i + (order - 1) : i - (order - 1);
                connectivity += fmt::format("{} ", ids[static_cast<std::size_t>(place)]);
            }
            offsets += fmt::format("{} ", (cell + 1) * per_cell);
            types += "72 ";
        }
        text += fmt::format(
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><Points><DataArray type=\"Float64\" "
            "NumberOfComponents=\"3\" format=\"ascii\">{}</DataArray></Points><Cells><DataArray type=\"Int64\" "
            "Name=\"connectivity\" format=\"ascii\">{}</DataArray><DataArray type=\"Int64\" Name=\"offsets\" "
            "format=\"ascii\">{}</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{}</DataArray>"
            "</Cells></Piece>\n",
            nodes, cells, points, connectivity, offsets, types);
    }
    return text + "</UnstructuredGrid>\n</VTKFile>\n";
}

TEST(VtkOrder, hexahedra_of_old_versions_are_renumbered_once_whatever_the_pieces) {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    for (const int order : {2, 3, 4}) {
        const CurvedMesh mesh = shaken(hex_mesh(2, order), 0.01, random);
        for (const char* version : {"0.1", "1.0", "2.0", "2.1", "2.2"})
            for (std::size_t pieces = 1; pieces <= 3; ++pieces) {
                const std::vector<CurvedMesh> all(pieces, mesh);
                const ReadResult result = read_mesh(folder.write("a.vtu", hexahedra_of_version(all, version)));
                ASSERT_EQ(result.mesh.topology().element_count(), static_cast<Index>(8 * pieces));
                for (Index cell = 0; cell < result.mesh.topology().element_count(); ++cell)
                    EXPECT_EQ(result.mesh.element_coordinates(cell), mesh.element_coordinates(cell % 8))
                        << version << " " << pieces << " pieces, cell " << cell;
            }
    }
}

TEST(VtkOrder, odd_versions_are_no_obstacle) {
    const TemporaryFolder folder;
    const std::string good = hexahedra_of_version({hex_mesh(1, 2)}, "1.0");
    for (const char* version : {"", "x", "-1", ".", "1", "99999999999999999999.1", "2.", "3.0"}) {
        std::string text = good;
        text.replace(text.find("version=\"1.0\" byte"), 13, std::string("version=\"") + version + "\"");
        const auto file = folder.write("a.vtu", text);
        try {
            EXPECT_EQ(read_mesh(file).mesh.topology().element_count(), 1) << version;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find("a.vtu"), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace curvewright
