#include "core/io/vtk_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "core/base/error.h"
#include "core/basis/node_ordering.h"
#include "core/basis/reference_element.h"
#include "core/io/mesh_entities.h"
#include "core/io/vtk_cells.h"
#include "core/io/vtk_field_data.h"

namespace curvewright {
namespace {

constexpr const char *node_tag_name = "NodeTag", *element_tag_name = "ElementTag", *entity_tag_name = "EntityTag";

// ---------------------------------------------------------------------------------------------------- mesh to grid

void fill_points(vtkUnstructuredGrid& grid, const CurvedMesh& mesh, const WriteOptions& options) {
    const Index count = mesh.topology().node_count();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(count);
    auto tags = new_array<vtkTypeInt64Array>(node_tag_name, 1, count);
    for (Index node = 0; node < count; ++node) {
        const auto x = mesh.coordinates().row(node);
        points->SetPoint(node, x(0), x(1), x(2));
        tags->SetValue(node, mesh.topology().node_tag(node).value);
    }
    grid.SetPoints(points);
    grid.GetPointData()->AddArray(tags);
    if (options.reference == nullptr) return;
    if (options.reference->rows() != count)
        throw InvalidInput(fmt::format("The reference positions are {}, but the mesh has {} nodes.",
                                       options.reference->rows(), count));
    auto displacement = new_array<vtkDoubleArray>("Displacement", 3, count);
    for (Index node = 0; node < count; ++node)
        for (int d = 0; d < 3; ++d)
            displacement->SetComponent(node, d, mesh.coordinates()(node, d) - (*options.reference)(node, d));
    grid.GetPointData()->AddArray(displacement);
}

void fill_cells(vtkUnstructuredGrid& grid, const CurvedMesh& mesh, const WriteOptions& options, bool is_legacy_text) {
    const MeshTopology& topology = mesh.topology();
    std::map<EntityKey, int> group_of_entity;
    for (const Entity& entity : topology.entities())
        if (!entity.physical_tags.empty())
            group_of_entity[{entity.dimension, entity.tag}] = entity.physical_tags.front();
    const QualityReport* quality = options.quality;
    if (quality != nullptr && quality->elements.size() != static_cast<std::size_t>(topology.element_count()))
        throw InvalidInput(fmt::format("The quality report is for {} elements, but the mesh has {}.",
                                       quality->elements.size(), topology.element_count()));

    vtkNew<vtkCellArray> cells;
    vtkNew<vtkUnsignedCharArray> types;
    const auto tags = new_array<vtkTypeInt64Array>(element_tag_name, 1, 0);
    const auto entities = new_array<vtkIntArray>(entity_tag_name, 1, 0);
    const auto groups = new_array<vtkIntArray>("PhysicalGroup", 1, 0);
    const auto jacobian = new_array<vtkDoubleArray>("ScaledJacobian", 1, 0);
    const auto validity = new_array<vtkIntArray>("Validity", 1, 0);
    const double no_jacobian = is_legacy_text ? 1.0 : std::numeric_limits<double>::quiet_NaN();
    std::size_t element = 0;
    std::vector<vtkIdType> ids;
    for (const ElementBlock& block : topology.blocks()) {
        if (block.size() == 0) continue;
        if (block.type.shape == Shape::pyramid && block.type.order > 1)
            throw Unsupported(
                fmt::format("VTK has no {}: the mesh cannot be written in this format.", name(block.type)));
        const int dim = dimension(block.type.shape);
        const auto per_element = static_cast<std::size_t>(node_count(block.type));
        const auto group = group_of_entity.find({dim, block.entity_tag});
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(i * per_element);
            ids.assign(first, first + static_cast<std::ptrdiff_t>(per_element));
            if (block.type == linear_prism) swap_prism_corners(ids);
            cells->InsertNextCell(static_cast<vtkIdType>(per_element), ids.data());
            types->InsertNextValue(static_cast<unsigned char>(vtk_type_of(block.type)));
            tags->InsertNextValue(block.tags[i].value);
            entities->InsertNextValue(block.entity_tag);
            groups->InsertNextValue(group == group_of_entity.end() ? 0 : group->second);
            if (quality == nullptr) continue;
            const bool is_element = dim == topology.dimension() && dim > 0;
            const bool is_assessed = is_element && quality->elements[element].validity != Validity::not_assessed;
            jacobian->InsertNextValue(is_assessed                    ? quality->elements[element].scaled_jacobian
                                      : is_element && is_legacy_text ? 0.0  // nothing is known of it
                                                                     : no_jacobian);
            int state = -1;
            if (is_element) {
                const Validity proved = quality->elements[element++].validity;
                state = proved == Validity::valid       ? 1
                        : proved == Validity::invalid   ? 0
                        : proved == Validity::undecided ? 2
                                                        : 3;
            }
            validity->InsertNextValue(state);
        }
    }
    grid.SetCells(types, cells);
    for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{tags, entities, groups})
        grid.GetCellData()->AddArray(array);
    if (quality == nullptr) return;
    grid.GetCellData()->AddArray(jacobian);
    grid.GetCellData()->AddArray(validity);
}

/// Whether the cells of a block are what the mesh calls its elements.
bool holds_elements(const ElementBlock& block, const MeshTopology& topology) {
    const int dim = dimension(block.type.shape);
    return dim > 0 && dim == topology.dimension();
}

/// values: in the order of the grid's points or cells.
vtkSmartPointer<vtkDataArray> field_array(const FieldArray& field, std::vector<double> values, bool is_legacy_text,
                                          std::vector<std::string>& notes) {
    bool is_integer = field.is_integer;
    std::size_t missing = 0;
    for (double& value : values) {
        if (is_legacy_text && !std::isfinite(value)) {
            value = 0.0;
            ++missing;
        }
        is_integer = is_integer && std::abs(value) < 9e15 && value == std::floor(value);
    }
    if (missing > 0)
        notes.push_back(
            fmt::format("Of the array {}, {} values that are missing were written as 0, because legacy VTK "
                        "text cannot say so; .vtu can.",
                        field.name, missing));
    const auto rows = static_cast<vtkIdType>(values.size()) / field.components;
    if (is_integer) {
        auto array = new_array<vtkTypeInt64Array>(field.name.c_str(), field.components, rows);
        std::copy(values.begin(), values.end(), array->GetPointer(0));
        return array;
    }
    auto array = new_array<vtkDoubleArray>(field.name.c_str(), field.components, rows);
    std::copy(values.begin(), values.end(), array->GetPointer(0));
    return array;
}

/// The values of all cells in the order of the blocks.
std::vector<double> cell_values(const FieldArray& field, const MeshTopology& topology) {
    const auto width = static_cast<std::size_t>(field.components);
    std::vector<double> values;
    std::size_t element = 0, lower = 0;
    for (const ElementBlock& block : topology.blocks()) {
        const bool are_elements = holds_elements(block, topology);
        const std::size_t count = width * block.tags.size();
        const std::vector<double>& from = are_elements ? field.values : field.lower_values;
        std::size_t& next = are_elements ? element : lower;
        if (from.empty()) {
            values.insert(values.end(), count, std::numeric_limits<double>::quiet_NaN());
        } else {
            const auto begin = from.begin() + static_cast<std::ptrdiff_t>(next);
            values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
        }
        next += count;
    }
    return values;
}

void fill_fields(vtkUnstructuredGrid& grid, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                 bool is_legacy_text, std::vector<std::string>& notes) {
    for (const FieldArray& field : fields) {
        const bool is_on_nodes = field.place == FieldArray::Place::nodes;
        vtkFieldData* data = is_on_nodes ? static_cast<vtkFieldData*>(grid.GetPointData()) : grid.GetCellData();
        if (data->HasArray(field.name.c_str()) != 0) continue;
        if (is_on_nodes) {
            data->AddArray(field_array(field, field.values, is_legacy_text, notes));
            continue;
        }
        FieldArray whole = field;
        // That boundary cells have no values is nothing to tell of.
        if (is_legacy_text && whole.lower_values.empty()) {
            std::size_t cells = 0;
            for (const ElementBlock& block : mesh.topology().blocks()) cells += block.tags.size();
            whole.lower_values.assign((cells - field.size()) * static_cast<std::size_t>(field.components), 0.0);
        }
        data->AddArray(field_array(field, cell_values(whole, mesh.topology()), is_legacy_text, notes));
    }
}

// ---------------------------------------------------------------------------------------------------- grid to mesh

class GridReader {
  public:
    GridReader(vtkUnstructuredGrid& grid, std::string file, MeshFormat format, HexahedronOrder order)
        : grid_(grid), file_(std::move(file)), format_(format), hexahedron_order_(order) {}

    ReadResult read() {
        if (grid_.GetNumberOfCells() == 0 || grid_.GetPoints() == nullptr)
            fail("the file holds no cells; a mesh was expected.");
        if (grid_.GetNumberOfPoints() > std::numeric_limits<Index>::max() / 4)
            throw Unsupported(fmt::format("{}: the mesh has too many points.", file_));
        read_points();
        read_cells();
        settle_old_prisms();
        read_field_data(*grid_.GetFieldData(), data_, notes_);
        if (!is_ours_) note_gmsh_order();
        complete_entities(data_, coordinates_);
        complete_groups(data_);
        CurvedMesh mesh = assemble_mesh(std::move(data_), std::move(coordinates_), file_);
        std::vector<FieldArray> fields = read_fields(*grid_.GetPointData(), FieldArray::Place::nodes, mesh.topology());
        for (FieldArray& field : read_fields(*grid_.GetCellData(), FieldArray::Place::elements, mesh.topology()))
            fields.push_back(std::move(field));
        make_names_unique(fields);
        return {std::move(mesh), format_, std::move(notes_), std::move(fields)};
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(file_, 0, message); }
    void read_points();
    void check_connectivity();
    void read_cells();
    void settle_old_prisms();
    void note_gmsh_order();
    std::vector<FieldArray> read_fields(vtkDataSetAttributes& data, FieldArray::Place place,
                                        const MeshTopology& topology);

    vtkUnstructuredGrid& grid_;
    std::string file_;
    MeshFormat format_;
    HexahedronOrder hexahedron_order_;
    bool is_ours_ = false;
    bool may_be_old_ = false;  ///< written by this program before it had linear prisms in VTK's order
    MeshData data_;
    Coordinates coordinates_;
    std::vector<std::string> notes_;
};

void GridReader::read_points() {
    const vtkIdType count = grid_.GetNumberOfPoints();
    coordinates_.resize(count, 3);
    for (vtkIdType i = 0; i < count; ++i) grid_.GetPoint(i, coordinates_.row(i).data());
    const auto tags = integer_values(*grid_.GetPointData(), node_tag_name, 1, count);
    is_ours_ = tags.has_value();
    bool is_usable = tags.has_value();
    std::unordered_set<std::int64_t> seen;
    for (std::size_t i = 0; is_usable && i < tags->size(); ++i)
        is_usable = (*tags)[i] >= 0 && seen.insert((*tags)[i]).second;
    if (tags && !is_usable)
        notes_.push_back(
            fmt::format("The array {} has negative or repeated values: nodes were numbered from 1.", node_tag_name));
    for (vtkIdType i = 0; i < count; ++i)
        data_.node_tags.push_back({is_usable ? (*tags)[static_cast<std::size_t>(i)] : i + 1});
}

void GridReader::check_connectivity() {
    vtkCellArray* cells = grid_.GetCells();
    vtkDataArray *offsets = cells->GetOffsetsArray(), *connectivity = cells->GetConnectivityArray();
    const vtkIdType count = grid_.GetNumberOfCells();
    if (cells->GetNumberOfCells() != count || offsets->GetNumberOfValues() != count + 1 ||
        grid_.GetCellTypesArray() == nullptr || grid_.GetCellTypesArray()->GetNumberOfValues() < count)
        fail("the numbers of cells, offsets and cell types do not agree.");
    double previous = 0.0;
    for (vtkIdType i = 0; i <= count; ++i) {
        const double offset = offsets->GetTuple1(i);
        if (offset < previous || (i == 0 && offset != 0.0) ||
            offset > static_cast<double>(connectivity->GetNumberOfValues()))
            fail(fmt::format("the offsets of the cells are damaged at cell {}.", i));
        previous = offset;
    }
    const auto points = static_cast<double>(grid_.GetNumberOfPoints());
    for (vtkIdType i = 0; i < connectivity->GetNumberOfValues(); ++i)
        if (const double point = connectivity->GetTuple1(i); point < 0.0 || point >= points)
            fail(fmt::format("a cell refers to point {}, but there are {} points.", point, points));
}

void GridReader::read_cells() {
    check_connectivity();
    const vtkIdType count = grid_.GetNumberOfCells();
    auto tags = integer_values(*grid_.GetCellData(), element_tag_name, 1, count);
    const auto entities = integer_values(*grid_.GetCellData(), entity_tag_name, 1, count);
    vtkDataArray* degrees = grid_.GetCellData()->GetHigherOrderDegrees();
    if (degrees != nullptr && (degrees->GetNumberOfComponents() != 3 || degrees->GetNumberOfTuples() != count))
        degrees = nullptr;
    std::map<std::pair<int, vtkIdType>, ReadableCell> known;
    std::set<std::pair<int, std::int64_t>> seen;
    bool has_bad_tags = false;
    vtkIdType gmsh_cells = 0;
    may_be_old_ = is_ours_ && tags && entities && !field_data_version(*grid_.GetFieldData());
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < count; ++cell) {
        const int vtk_type = grid_.GetCellType(cell);
        grid_.GetCells()->GetCellAtId(cell, ids);
        const vtkIdType points = ids->GetNumberOfIds();
        auto found = known.find({vtk_type, points});
        if (found == known.end()) {
            auto readable = readable_cell(vtk_type, points);
            if (!readable)
                throw Unsupported(fmt::format(
                    "{}: cell {} is a {} (VTK type {}) with {} points, which is not supported; linear, Lagrange (up to "
                    "order {}) and complete quadratic cells are.",
                    file_, cell, vtkCellTypes::GetClassNameFromTypeId(vtk_type), vtk_type, points, max_order));
            if (vtk_type == VTK_LAGRANGE_HEXAHEDRON && hexahedron_order_ == HexahedronOrder::vtk8)
                readable->permutation = permutation_from_vtk8(readable->type.order);
            found = known.emplace(std::pair(vtk_type, points), *readable).first;
        }
        const auto& [type, permutation, is_gmsh_export] = found->second;
        gmsh_cells += is_gmsh_export ? 1 : 0;
        for (int d = 0; degrees != nullptr && d < dimension(type.shape); ++d)
            if (type.order > 1 && degrees->GetComponent(cell, d) != type.order)
                throw Unsupported(fmt::format(
                    "{}: cell {} has different orders along its axes, which is not supported.", file_, cell));
        const auto place = static_cast<std::size_t>(cell);
        const std::int64_t entity = entities ? (*entities)[place] : 0;
        ElementBlock& block = block_for(
            data_.blocks, type, std::abs(entity) < std::numeric_limits<int>::max() ? static_cast<int>(entity) : 0);
        const std::int64_t tag = tags ? (*tags)[place] : cell + 1;
        has_bad_tags = has_bad_tags || tag < 0 || !seen.emplace(dimension(type.shape), tag).second;
        block.tags.push_back({tag});
        for (vtkIdType i = 0; i < points; ++i)
            block.nodes.push_back(
                static_cast<Index>(ids->GetId(permutation.empty() ? i : permutation[static_cast<std::size_t>(i)])));
    }
    if (gmsh_cells > 0)
        notes_.push_back(
            fmt::format("{} cells are of a linear VTK type but have the points of a higher order: they were read as "
                        "Gmsh writes such cells, in Gmsh's node order.",
                        gmsh_cells));
    if (!has_bad_tags) return;
    notes_.push_back(
        fmt::format("The array {} has negative or repeated values: elements were numbered from 1.", element_tag_name));
    std::int64_t next = 1;
    for (ElementBlock& block : data_.blocks)
        for (ElementTag& tag : block.tags) tag.value = next++;
}

/// Earlier versions of this program wrote linear prisms with the base that VTK takes for its mirror image. Files of
/// ours that do not tell their version are of those, or of later ones and have lost it in another program. The two
/// readings differ in the sense of the prisms and in nothing else, so the other cells decide, or that prisms are
/// positive.
void GridReader::settle_old_prisms() {
    long prisms = 0, others = 0, count = 0;  // positive minus negative ones, as VTK would have them
    for (const ElementBlock& block : data_.blocks) {
        if (!may_be_old_ || dimension(block.type.shape) != 3) continue;
        const auto per_element = static_cast<std::ptrdiff_t>(node_count(block.type));
        const bool is_quadrilateral_based = block.type.shape == Shape::hexahedron || block.type.shape == Shape::pyramid;
        const int second = is_quadrilateral_based ? 3 : 2, third = is_quadrilateral_based ? 4 : 3;
        for (Index i = 0; i < block.size(); ++i) {
            const Index* nodes = block.nodes.data() + i * per_element;
            const Eigen::RowVector3d origin = coordinates_.row(nodes[0]);
            Eigen::Matrix3d edges;
            edges << coordinates_.row(nodes[1]) - origin, coordinates_.row(nodes[second]) - origin,
                coordinates_.row(nodes[third]) - origin;
            const double volume = edges.determinant();
            (block.type == linear_prism ? prisms : others) += volume > 0.0 ? 1 : volume < 0.0 ? -1 : 0;
            count += block.type == linear_prism;
        }
    }
    if (count == 0) return;
    const bool is_old = others < 0 ? prisms > 0 : prisms < 0;
    if (!is_old) return;
    for (ElementBlock& block : data_.blocks)
        for (std::size_t first = 0; block.type == linear_prism && first < block.nodes.size(); first += 6) {
            std::swap(block.nodes[first + 1], block.nodes[first + 2]);
            std::swap(block.nodes[first + 4], block.nodes[first + 5]);
        }
    notes_.push_back(fmt::format(
        "{} linear prisms stand in the order in which earlier versions of this program wrote them, which is "
        "not VTK's; they were read in that order, and writing the file again mends it.",
        count));
}

/// Gmsh's own export writes curved tetrahedra with Gmsh's node order: nodes then lie far from where a nearly
/// straight-sided cell has them, and near it when they are put in order.
void GridReader::note_gmsh_order() {
    std::size_t tetrahedra = 0, suspicious = 0;
    for (const ElementBlock& block : data_.blocks) {
        if (block.type.shape != Shape::tetrahedron || block.type.order < 3) continue;
        const auto& lattice = reference_element(block.type).lattice;
        const auto& permutation = gmsh_permutation(block.type);
        const double p = block.type.order;
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
            const Index* nodes = block.nodes.data() + i * lattice.size();
            double as_read = 0.0, in_order = 0.0;
            for (std::size_t k = 0; k < lattice.size(); ++k) {
                Eigen::RowVector3d straight = coordinates_.row(nodes[0]);
                for (int d = 0; d < 3; ++d)
                    straight += lattice[k][d] / p * (coordinates_.row(nodes[d + 1]) - coordinates_.row(nodes[0]));
                as_read += (coordinates_.row(nodes[k]) - straight).squaredNorm();
                in_order += (coordinates_.row(nodes[permutation[k]]) - straight).squaredNorm();
            }
            ++tetrahedra;
            suspicious += in_order < 0.25 * as_read;
        }
    }
    if (2 * suspicious > tetrahedra)
        notes_.push_back(
            fmt::format("{} of {} tetrahedra look as if their nodes stood in Gmsh's order instead of VTK's "
                        "(Gmsh's own VTK export does that); export MSH from Gmsh and read that instead.",
                        suspicious, tetrahedra));
}

std::vector<FieldArray> GridReader::read_fields(vtkDataSetAttributes& data, FieldArray::Place place,
                                                const MeshTopology& topology) {
    const bool is_on_nodes = place == FieldArray::Place::nodes;
    const vtkIdType rows = is_on_nodes ? grid_.GetNumberOfPoints() : grid_.GetNumberOfCells();
    // Bookkeeping, and what is computed anew for every file that this program writes.
    std::set<std::string> skipped = {node_tag_name, element_tag_name, entity_tag_name, "vtkGhostType"};
    if (is_ours_ && !is_on_nodes) skipped.insert({"PhysicalGroup", "ScaledJacobian", "Validity"});
    std::vector<FieldArray> fields;
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
        vtkAbstractArray* any = data.GetAbstractArray(i);
        if (any == nullptr || (!is_on_nodes && any == data.GetHigherOrderDegrees())) continue;
        FieldArray field;
        field.name = any->GetName() != nullptr ? any->GetName() : "";
        if (field.name.empty()) field.name = fmt::format("array {}", i + 1);
        if (skipped.contains(field.name)) continue;
        auto* array = vtkDataArray::SafeDownCast(any);
        if (array == nullptr || array->GetNumberOfTuples() != rows || array->GetNumberOfComponents() < 1) {
            notes_.push_back(fmt::format("The array {} was left out: it {}.", field.name,
                                         array == nullptr
                                             ? "holds no numbers"
                                             : fmt::format("has {} rows for {} {}", array->GetNumberOfTuples(), rows,
                                                           is_on_nodes ? "points" : "cells")));
            continue;
        }
        field.place = place;
        field.components = array->GetNumberOfComponents();
        field.is_integer = array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
        const auto width = static_cast<std::size_t>(field.components);
        std::vector<double> row(width);
        bool has_lower = false;
        const auto take = [&](vtkIdType at, std::vector<double>& to) {
            array->GetTuple(at, row.data());
            to.insert(to.end(), row.begin(), row.end());
            has_lower = has_lower || (&to == &field.lower_values &&
                                      std::any_of(row.begin(), row.end(), [](double v) { return !std::isnan(v); }));
        };
        field.values.reserve(width * static_cast<std::size_t>(rows));
        if (is_on_nodes) {
            for (vtkIdType at = 0; at < rows; ++at) take(at, field.values);
        } else {
            vtkIdType cell = 0;
            for (const ElementBlock& block : topology.blocks())
                for (Index k = 0; k < block.size(); ++k)
                    take(cell++, holds_elements(block, topology) ? field.values : field.lower_values);
        }
        if (!has_lower) field.lower_values.clear();
        fields.push_back(std::move(field));
    }
    return fields;
}

}  // namespace

void fill_grid(vtkUnstructuredGrid& grid, const CurvedMesh& mesh, const WriteOptions& options, bool is_legacy_text,
               std::vector<std::string>& notes) {
    fill_points(grid, mesh, options);
    fill_cells(grid, mesh, options, is_legacy_text);
    if (options.fields != nullptr) fill_fields(grid, mesh, *options.fields, is_legacy_text, notes);
    fill_field_data(*grid.GetFieldData(), mesh.topology().data(), options.provenance);
}

ReadResult mesh_of_grid(vtkUnstructuredGrid& grid, const std::string& file, MeshFormat format, HexahedronOrder order) {
    return GridReader(grid, file, format, order).read();
}

}  // namespace curvewright
