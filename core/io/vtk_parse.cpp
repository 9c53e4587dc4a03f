#include "core/io/vtk_parse.h"

#include <exception>
#include <new>

#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "core/io/vtk_messages.h"

namespace curvewright {
namespace {

template <class Reader>
VtkParse run(Reader& reader, bool with_warnings) {
    VtkParse result;
    const Capture capture;
    try {
        reader.Update();
        const bool has_error = capture.has_error(with_warnings);
        if (has_error || reader.GetErrorCode() != vtkErrorCode::NoError || reader.GetOutput() == nullptr)
            result.failure = has_error ? capture.message() : "VTK gives no reason";
        else
            result.grid = reader.GetOutput();
    } catch (const std::bad_alloc&) {
        result.is_out_of_memory = true;
    } catch (const std::exception& error) {
        result.failure = error.what();
    }
    return result;
}

}  // namespace

VtkParse parse_vtk(const std::string& path, bool is_xml) {
    if (is_xml) {
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->SetFileName(path.c_str());
        return run(*reader, false);
    }
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    return run(*reader, true);
}

}  // namespace curvewright
