#include "core/io/vtk_io.h"

#include <algorithm>
#include <charconv>
#include <climits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "core/base/error.h"
#include "core/io/vtk_answer.h"
#include "core/io/vtk_check.h"
#include "core/io/vtk_grid.h"
#include "core/io/vtk_messages.h"
#include "core/io/vtk_process.h"

namespace curvewright {
namespace {

/// The rows of an array of numbers, in the shortest form that reads back as the same numbers.
std::string exact_rows(vtkDataArray& array) {
    fmt::memory_buffer text;
    for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i)
        for (int d = 0; d < array.GetNumberOfComponents(); ++d)
            fmt::format_to(std::back_inserter(text), "{}{}", array.GetComponent(i, d),
                           d + 1 < array.GetNumberOfComponents() ? ' ' : '\n');
    return fmt::to_string(text);
}

/// A name as VTK writes it into legacy files.
std::string encoded(const char* name) {
    std::string text;
    for (const char* at = name; *at != 0; ++at) {
        const auto c = static_cast<unsigned char>(*at);
        if (c < 33 || c > 126 || c == '"' || c == '%')
            text += fmt::format("%{:02X}", c);
        else
            text += *at;
    }
    return text;
}

/// Names with what has a meaning in XML, which VTK 9.1 writes as it is and cannot read again.
void escape_names(vtkFieldData& data) {
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
        vtkAbstractArray* array = data.GetAbstractArray(i);
        std::string text;
        for (const char c : std::string_view(array->GetName()))
            text += c == '&'   ? "&amp;"
                    : c == '<' ? "&lt;"
                    : c == '>' ? "&gt;"
                    : c == '"' ? "&quot;"
                               : std::string(1, static_cast<unsigned char>(c) < ' ' ? ' ' : c);
        if (text != array->GetName()) array->SetName(text.c_str());
    }
}

/// Puts all digits of an array into a legacy text file, where VTK writes eleven. header: the line before the numbers.
void restore_digits(std::string& text, const std::string& header, vtkDataArray& array) {
    const std::size_t found = text.find("\n" + header + "\n");
    if (found == text.npos) return;
    const std::size_t begin = found + header.size() + 2;
    std::size_t end = begin;
    const char* blanks = " \t\r\n";
    for (vtkIdType left = array.GetNumberOfValues(); left > 0; --left) {
        end = text.find_first_of(blanks, text.find_first_not_of(blanks, end));
        if (end == text.npos) return;
    }
    text.replace(begin, text.find('\n', end) + 1 - begin, exact_rows(array));
}

/// The grid as a legacy text file with all digits.
std::string legacy_text(vtkUnstructuredGridWriter& writer, vtkUnstructuredGrid& grid) {
    writer.WriteToOutputStringOn();
    if (writer.Write() == 0) return {};
    std::string text = writer.GetOutputStdString();
    restore_digits(text, fmt::format("POINTS {} double", grid.GetNumberOfPoints()), *grid.GetPoints()->GetData());
    for (vtkFieldData* data :
         std::initializer_list<vtkFieldData*>{grid.GetFieldData(), grid.GetPointData(), grid.GetCellData()})
        for (int i = 0; i < data->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = data->GetArray(i); array != nullptr && array->GetDataType() == VTK_DOUBLE)
                restore_digits(text,
                               fmt::format("{} {} {} double", encoded(array->GetName()), array->GetNumberOfComponents(),
                                           array->GetNumberOfTuples()),
                               *array);
    return text;
}

/// The version of a VTK XML file becomes 2.1 if it is an earlier one. VTK renumbers the Lagrange hexahedra of those
/// once for every piece, which is right for one piece only; told that there is nothing to renumber it leaves them
/// alone.
HexahedronOrder hide_old_version(std::string& text) {
    const std::size_t tag = text.find("<VTKFile");
    const std::size_t tag_end = text.find('>', tag);
    if (tag == text.npos || tag_end == text.npos) return HexahedronOrder::vtk9;
    const std::string_view head = std::string_view(text).substr(tag, tag_end - tag);
    constexpr std::string_view blanks = " \t\r\n", key = "version";
    for (std::size_t found = head.find(key); found != head.npos; found = head.find(key, found + 1)) {
        if (blanks.find(head[found - 1]) == blanks.npos) continue;
        std::size_t at = head.find_first_not_of(blanks, found + key.size());
        if (at == head.npos || head[at] != '=') continue;
        at = head.find_first_not_of(blanks, at + 1);
        if (at == head.npos || (head[at] != '"' && head[at] != '\'')) continue;
        const std::size_t end = head.find(head[at], at + 1);
        if (end == head.npos) continue;
        const std::string_view version = head.substr(at + 1, end - at - 1);
        int major = 0, minor = 0;
        const auto [dot, error] = std::from_chars(version.data(), version.data() + version.size(), major);
        if (error != std::errc()) continue;
        if (dot != version.data() + version.size()) std::from_chars(dot + 1, version.data() + version.size(), minor);
        if (std::pair(major, minor) >= std::pair(2, 1)) return HexahedronOrder::vtk9;
        text.replace(tag + at + 1, version.size(), "2.1");
        return HexahedronOrder::vtk8;
    }
    return HexahedronOrder::vtk9;
}

}  // namespace

const char* check_vtk_text(std::string_view text, const std::string& file, MeshFormat format) {
    if (format == MeshFormat::vtu) {
        const char* expected = "a VTK XML unstructured grid";
        if (text.substr(0, 4096).find("UnstructuredGrid") == text.npos)
            throw InvalidInput(file, 0, fmt::format("the file is not {}.", expected));
        check_xml_arrays(text, file);
        return expected;
    }
    const char* expected = "a legacy VTK file with an unstructured grid";
    if (!text.starts_with("# vtk DataFile") || text.substr(0, 4096).find("UNSTRUCTURED_GRID") == text.npos)
        throw InvalidInput(file, 0, fmt::format("the file is not {}.", expected));
    if (text.size() > static_cast<std::size_t>(INT_MAX))
        throw Unsupported(fmt::format("{}: legacy VTK files above 2 GB are not supported; use .vtu.", file));
    LegacyVtkCheck(text, file).run();
    return expected;
}

ReadResult mesh_of_vtk_answer(std::span<std::byte> answer, const std::string& file, MeshFormat format,
                              HexahedronOrder order) {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    try {
        const Capture capture;
        grid = grid_of_vtk_answer(answer);
    } catch (const InvalidInput& error) {
        throw InvalidInput(
            file, 0,
            fmt::format("the answer of the program that reads VTK files cannot be understood ({}).", error.what()));
    }
    return mesh_of_grid(*grid, file, format, order);
}

ReadResult read_vtk(std::string text, const std::string& file, MeshFormat format, const TaskContext& context) {
    const char* expected = check_vtk_text(text, file, format);
    const HexahedronOrder order = format == MeshFormat::vtu ? hide_old_version(text)
                                                            : HexahedronOrder::vtk9;  // legacy files: VTK sees to it
    const VtkReaderLimits limits = vtk_reader_limits(text.size());
    const auto answer =
        read_in_vtk_process(std::move(text), format == MeshFormat::vtu, file, expected, limits, context);
    context.report("reading", 0.5);
    ReadResult result = mesh_of_vtk_answer(answer->bytes(), file, format, order);
    context.report("reading", 1.0);
    return result;
}

namespace {

/// XML, in which VTK asks for names that are escaped.
std::string xml_text(vtkUnstructuredGrid& grid, bool is_text) {
    escape_names(*grid.GetPointData());
    escape_names(*grid.GetCellData());
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->WriteToOutputStringOn();
    writer->SetInputData(&grid);
    if (is_text) {
        writer->SetDataModeToAscii();
    } else {
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        writer->SetCompressorTypeToZLib();
    }
    return writer->Write() == 0 ? std::string() : writer->GetOutputString();
}

/// The values of an integer array as one of another type; null if they do not fit.
template <class To, class From>
vtkSmartPointer<vtkAbstractArray> converted(From& array) {
    using Value = typename To::ValueType;
    const auto* values = array.GetPointer(0);
    const vtkIdType count = array.GetNumberOfValues();
    if (!std::all_of(values, values + count, [](vtkTypeInt64 value) { return std::in_range<Value>(value); })) return {};
    vtkNew<To> result;
    result->SetName(array.GetName());
    result->SetNumberOfComponents(array.GetNumberOfComponents());
    result->SetNumberOfTuples(array.GetNumberOfTuples());
    std::copy(values, values + count, result->GetPointer(0));
    return result.Get();
}

template <class To>
vtkSmartPointer<vtkAbstractArray> with_integers(vtkAbstractArray* array) {
    vtkSmartPointer<vtkAbstractArray> result;
    if (auto* wide = vtkTypeInt64Array::SafeDownCast(array)) result = converted<To>(*wide);
    if (auto* narrow = vtkIntArray::SafeDownCast(array)) result = converted<To>(*narrow);
    if (auto* bytes = vtkUnsignedCharArray::SafeDownCast(array)) result = converted<To>(*bytes);
    return result != nullptr ? result : vtkSmartPointer<vtkAbstractArray>(array);
}

/// Makes all integers, and bytes, those that other programs know in legacy files: of 32 bits ("int") in version 4.2,
/// where they fit, of 64 bits ("vtktypeint64") in version 5.1.
void use_common_integers(vtkFieldData& data, bool is_version_5) {
    std::vector<vtkSmartPointer<vtkAbstractArray>> arrays;
    for (int i = 0; i < data.GetNumberOfArrays(); ++i)
        arrays.push_back(is_version_5 ? with_integers<vtkTypeInt64Array>(data.GetAbstractArray(i))
                                      : with_integers<vtkIntArray>(data.GetAbstractArray(i)));
    data.Initialize();
    for (vtkAbstractArray* array : arrays) data.AddArray(array);
}

std::string legacy_file_text(vtkUnstructuredGrid& grid, const MeshTopology& topology, bool is_text) {
    vtkNew<vtkUnstructuredGridWriter> writer;
    writer->SetHeader("Curvewright mesh");
    // Version 4.2 is what most other programs read, but Lagrange cells only those that read 5.1 as well, and hexahedra
    // among them VTK takes to be in its old order in 4.2.
    const auto& blocks = topology.blocks();
    const bool has_lagrange_cells =
        std::any_of(blocks.begin(), blocks.end(), [](const ElementBlock& block) { return block.type.order > 1; });
    writer->SetFileVersion(has_lagrange_cells ? vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_5_1
                                              : vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2);
    for (vtkFieldData* data :
         std::initializer_list<vtkFieldData*>{grid.GetFieldData(), grid.GetPointData(), grid.GetCellData()})
        use_common_integers(*data, has_lagrange_cells);
    writer->SetInputData(&grid);
    if (is_text) {
        writer->SetFileTypeToASCII();
        return legacy_text(*writer, grid);
    }
    writer->SetFileTypeToBinary();
    writer->WriteToOutputStringOn();
    return writer->Write() == 0 ? std::string() : std::string(writer->GetOutputStdString());
}

}  // namespace

std::string vtk_text(const std::string& target, const CurvedMesh& mesh, MeshFormat format, const WriteOptions& options,
                     std::vector<std::string>& notes) {
    const bool is_text = !options.binary.value_or(format == MeshFormat::vtu);
    vtkNew<vtkUnstructuredGrid> grid;
    try {
        fill_grid(*grid, mesh, options, is_text && format == MeshFormat::vtk, notes);
    } catch (const Unsupported& error) {
        throw Unsupported(fmt::format("{}: {}", target, error.what()));
    }
    // In memory, so that whatever the disk has to say is told as for every other file.
    Capture capture;
    std::string text =
        format == MeshFormat::vtu ? xml_text(*grid, is_text) : legacy_file_text(*grid, mesh.topology(), is_text);
    if (text.empty() || capture.has_error())
        throw InvalidInput(
            target, 0,
            fmt::format("the file cannot be written ({}).", capture.has_error() ? capture.message() : "out of memory"));
    return text;
}

}  // namespace curvewright
