#pragma once

#include <string>

namespace curvewright {

/// To be called before the QApplication: chooses the platform plugin and the OpenGL that the view needs. Returns "" or
/// why no window can be opened, as a sentence with what to do about it.
std::string prepare_display(int argc, char** argv);

/// To be called after it: "" if an OpenGL 3.2 context can be made, else why not.
std::string probe_opengl();

}  // namespace curvewright
