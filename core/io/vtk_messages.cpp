#include "core/io/vtk_messages.h"

namespace curvewright {
namespace {

std::mutex& capture_mutex() {
    static std::mutex instance;
    return instance;
}

}  // namespace

CapturingWindow* CapturingWindow::New() {
    auto* window = new CapturingWindow;
    window->InitializeObjectBase();
    return window;
}

void CapturingWindow::forward(const char* text, Display display) {
    if (std::this_thread::get_id() != thread_ && previous_ != nullptr) (previous_->*display)(text);
}

void CapturingWindow::keep(const char* text, std::string& place, Display display) {
    if (std::this_thread::get_id() == thread_ && place.empty()) place = text;
    forward(text, display);
}

Capture::Capture() : lock_(capture_mutex()), previous_(vtkOutputWindow::GetInstance()) {
    window_->set_previous(previous_);
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

Capture::~Capture() {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(previous_);
}

std::string Capture::message() const {
    std::string text = window_->error().empty() ? window_->warning() : window_->error();
    const std::size_t object = text.find("): ");
    if (object != text.npos) text = text.substr(object + 3);
    std::string line;
    for (const char c : text) {
        const char shown = c >= 0 && c < ' ' ? ' ' : c;
        if (shown != ' ' || (!line.empty() && line.back() != ' ')) line += shown;
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
    return line.substr(0, 300);
}

}  // namespace curvewright
