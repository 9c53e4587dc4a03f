#include "core/io/provenance.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/msh_io.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

Provenance some_provenance() {
    return {"Curvewright", "7.8.9", "curvewright-cli warp 'a b.msh' --deformation d.json", "a b.msh",
            "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"};
}

TEST(Provenance, is_a_line_per_thing_that_is_known) {
    EXPECT_EQ(provenance_text(some_provenance()),
              "Made by: Curvewright 7.8.9\nCommand: curvewright-cli warp 'a b.msh' --deformation d.json\n"
              "Input: a b.msh\n"
              "Input SHA-256: 0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef\n");
    Provenance odd;
    odd.command = "a\n$EndComments\r\x7f\tb";
    EXPECT_EQ(provenance_text(odd), "Made by: Curvewright\nCommand: a $EndComments   b\n");
}

TEST(Provenance, stands_in_msh_as_a_comment_that_changes_nothing_else) {
    const TemporaryFolder folder;
    Provenance provenance = some_provenance();
    provenance.command += "\n$EndComments\n$Nodes";
    const CurvedMesh mesh = one_element_mesh({Shape::triangle, 3});
    for (const MeshFormat format : {MeshFormat::msh2, MeshFormat::msh4}) {
        WriteOptions options;
        options.format = format;
        write_mesh(folder / "without.msh", mesh, options);
        options.provenance = &provenance;
        write_mesh(folder / "with.msh", mesh, options);
        std::string text = read_text_file(folder / "with.msh");
        const std::size_t begin = text.find("$Comments\n"), end = text.find("\n$EndComments\n") + 14;
        ASSERT_NE(begin, std::string::npos);
        EXPECT_EQ(text.substr(begin + 10, end - begin - 10 - 13), provenance_text(provenance));
        const ReadResult result = read_mesh(folder / "with.msh");
        EXPECT_TRUE(result.notes.empty());
        EXPECT_EQ(text.erase(begin, end - begin), read_text_file(folder / "without.msh"));
        if (format == MeshFormat::msh4) expect_same_model(mesh, result.mesh, "msh4");
    }
}

TEST(Provenance, stands_in_vtk_files_as_bytes_and_no_array_there_is_of_strings) {
    const TemporaryFolder folder;
    const Provenance provenance = some_provenance();
    CurvedMesh mesh = one_element_mesh({Shape::tetrahedron, 2});
    for (const bool is_binary : {false, true}) {
        WriteOptions options;
        options.provenance = &provenance;
        options.binary = is_binary;
        write_mesh(folder / "a.vtu", mesh, options);
        write_mesh(folder / "a.vtk", mesh, options);
        vtkNew<vtkXMLUnstructuredGridReader> xml;
        xml->SetFileName((folder / "a.vtu").c_str());
        xml->Update();
        vtkNew<vtkUnstructuredGridReader> legacy;
        legacy->SetFileName((folder / "a.vtk").c_str());
        legacy->Update();
        for (vtkUnstructuredGrid* grid : {xml->GetOutput(), legacy->GetOutput()}) {
            vtkFieldData* field = grid->GetFieldData();
            for (int i = 0; i < field->GetNumberOfArrays(); ++i)
                EXPECT_NE(vtkDataArray::SafeDownCast(field->GetAbstractArray(i)), nullptr) << "array " << i;
            vtkDataArray* bytes = field->GetArray("CurvewrightProvenance");
            ASSERT_NE(bytes, nullptr);
            EXPECT_EQ(bytes->GetDataType(), grid == xml->GetOutput() ? VTK_UNSIGNED_CHAR : VTK_TYPE_INT64);
            std::string text;
            for (vtkIdType i = 0; i < bytes->GetNumberOfTuples(); ++i) text += static_cast<char>(bytes->GetTuple1(i));
            EXPECT_EQ(text, provenance_text(provenance));
        }
        for (const char* file : {"a.vtu", "a.vtk"}) {
            const ReadResult result = read_mesh(folder / file);
            EXPECT_TRUE(result.notes.empty());
            expect_same_model(mesh, result.mesh, file);
        }
    }
}

TEST(FullDisk, is_told_in_one_sentence_by_every_format) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
    const CurvedMesh mesh = one_element_mesh({Shape::tetrahedron, 4});
    for (const MeshFormat format : {MeshFormat::msh2, MeshFormat::msh4, MeshFormat::vtu, MeshFormat::vtk})
        for (const bool is_binary : {false, true}) {
            WriteOptions options;
            options.format = format;
            if (format == MeshFormat::vtu || format == MeshFormat::vtk) options.binary = is_binary;
            const std::string message = message_of<InvalidInput>([&] { write_mesh("/dev/full", mesh, options); });
            EXPECT_EQ(message, "/dev/full: the file cannot be written (No space left on device).");
        }
}

}  // namespace
}  // namespace curvewright
