#include "core/io/vtk_io.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
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

ReadResult mesh_of_vtk_answer(std::span<std::byte> answer, const std::string& file, MeshFormat format) {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    try {
        const Capture capture;
        grid = grid_of_vtk_answer(answer);
    } catch (const InvalidInput& error) {
        throw InvalidInput(
            file, 0,
            fmt::format("the answer of the program that reads VTK files cannot be understood ({}).", error.what()));
    }
    return mesh_of_grid(*grid, file, format);
}

ReadResult read_vtk(std::string text, const std::string& file, MeshFormat format, const TaskContext& context) {
    const char* expected = check_vtk_text(text, file, format);
    const VtkReaderLimits limits = vtk_reader_limits(text.size());
    const auto answer =
        read_in_vtk_process(std::move(text), format == MeshFormat::vtu, file, expected, limits, context);
    context.report("reading", 0.5);
    ReadResult result = mesh_of_vtk_answer(answer->bytes(), file, format);
    context.report("reading", 1.0);
    return result;
}

void write_vtk(const std::filesystem::path& path, const std::string& target, const CurvedMesh& mesh, MeshFormat format,
               const WriteOptions& options, std::vector<std::string>& notes) {
    const bool is_text = !options.binary.value_or(format == MeshFormat::vtu);
    vtkNew<vtkUnstructuredGrid> grid;
    try {
        fill_grid(*grid, mesh, options, is_text && format == MeshFormat::vtk, notes);
    } catch (const Unsupported& error) {
        throw Unsupported(fmt::format("{}: {}", target, error.what()));
    }
    {
        errno = 0;
        if (!std::ofstream(path))  // VTK would only say that it failed
            throw InvalidInput(target, 0, fmt::format("the file cannot be written ({}).", std::strerror(errno)));
    }
    Capture capture;
    int is_written = 0;
    if (format == MeshFormat::vtu) {
        escape_names(*grid->GetPointData());
        escape_names(*grid->GetCellData());
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetFileName(path.c_str());
        writer->SetInputData(grid);
        if (is_text) {
            writer->SetDataModeToAscii();
        } else {
            writer->SetDataModeToAppended();
            writer->EncodeAppendedDataOff();
            writer->SetCompressorTypeToZLib();
        }
        is_written = writer->Write();
    } else {
        vtkNew<vtkUnstructuredGridWriter> writer;
        writer->SetFileName(path.c_str());
        writer->SetHeader("Curvewright mesh");
        // Version 4.2 is what most other programs read, but in it VTK takes Lagrange hexahedra to be in its old order.
        const auto& blocks = mesh.topology().blocks();
        const bool has_curved_hexahedra = std::any_of(blocks.begin(), blocks.end(), [](const ElementBlock& block) {
            return block.type.shape == Shape::hexahedron && block.type.order > 1;
        });
        writer->SetFileVersion(has_curved_hexahedra ? vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_5_1
                                                    : vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2);
        writer->SetInputData(grid);
        if (is_text) {
            writer->SetFileTypeToASCII();
            const std::string text = legacy_text(*writer, *grid);
            std::ofstream stream(path, std::ios::binary);
            stream << text;
            stream.close();
            is_written = !text.empty() && stream ? 1 : 0;
        } else {
            writer->SetFileTypeToBinary();
            is_written = writer->Write();
        }
    }
    if (is_written == 0 || capture.has_error())
        throw InvalidInput(target, 0,
                           fmt::format("the file cannot be written ({}).",
                                       capture.has_error() ? capture.message() : "is the disk full?"));
}

}  // namespace curvewright
