#pragma once

#include <mutex>
#include <string>
#include <thread>

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace curvewright {

/// Where VTK's complaints of one thread go while it reads or writes, instead of the terminal.
class CapturingWindow : public vtkOutputWindow {
  public:
    static CapturingWindow* New();

    void DisplayText(const char* text) override { forward(text, &vtkOutputWindow::DisplayText); }
    void DisplayErrorText(const char* text) override { keep(text, error_, &vtkOutputWindow::DisplayErrorText); }
    void DisplayWarningText(const char* text) override { keep(text, warning_, &vtkOutputWindow::DisplayWarningText); }
    void DisplayGenericWarningText(const char* text) override {
        keep(text, warning_, &vtkOutputWindow::DisplayGenericWarningText);
    }

    void set_previous(vtkOutputWindow* previous) { previous_ = previous; }
    /// The first of its kind; empty if there was none.
    const std::string& error() const { return error_; }
    const std::string& warning() const { return warning_; }

  private:
    using Display = void (vtkOutputWindow::*)(const char*);

    /// What other threads say meanwhile is passed on.
    void forward(const char* text, Display display);
    void keep(const char* text, std::string& place, Display display);

    std::thread::id thread_ = std::this_thread::get_id();
    vtkSmartPointer<vtkOutputWindow> previous_;
    std::string error_, warning_;
};

/// Catches VTK's complaints for its lifetime. One at a time: VTK has one output window and one log per process.
class Capture {
  public:
    Capture();
    ~Capture();
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    /// With warnings: legacy files that end too early give no more than that.
    bool has_error(bool with_warnings = false) const {
        return !window_->error().empty() || (with_warnings && !window_->warning().empty());
    }
    /// The first complaint as one line, without VTK's "ERROR: In FILE, line N" and the address of the object.
    std::string message() const;

  private:
    std::lock_guard<std::mutex> lock_;
    vtkSmartPointer<vtkOutputWindow> previous_;
    vtkNew<CapturingWindow> window_;
    vtkLogger::Verbosity verbosity_ = vtkLogger::GetCurrentVerbosityCutoff();
};

}  // namespace curvewright
