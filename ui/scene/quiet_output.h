#pragma once

#include <vtkLogger.h>
#include <vtkObject.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace curvewright {

/// Silences VTK's messages (console window and logger) while it lives.
class QuietOutput {
  public:
    QuietOutput()
        : warnings_(vtkObject::GetGlobalWarningDisplay()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
        vtkObject::GlobalWarningDisplayOff();
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~QuietOutput() {
        vtkLogger::SetStderrVerbosity(verbosity_);
        vtkObject::SetGlobalWarningDisplay(warnings_);
    }
    QuietOutput(const QuietOutput&) = delete;
    QuietOutput& operator=(const QuietOutput&) = delete;

  private:
    int warnings_;
    vtkLogger::Verbosity verbosity_;
};

}  // namespace curvewright
