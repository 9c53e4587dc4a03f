#include "ui/scene/offscreen.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLState.h>
#include <vtkPNGWriter.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "ui/scene/egl_context.h"
#include "ui/scene/quiet_output.h"

namespace curvewright {
namespace {

constexpr int max_side = 8192;        ///< of what is asked for
constexpr int max_drawn_side = 8192;  ///< of what is drawn before averaging, where the picture allows it

struct Pixels {
    int width = 0, height = 0;
    vtkNew<vtkUnsignedCharArray> rgb;  ///< 3 per pixel, rows from the bottom
};

/// A render window on a context of ours. GLEW looks for an X display after it has loaded all functions of OpenGL, and
/// VTK gives up when GLEW finds none; what VTK would have done next is done here.
class EglRenderWindow : public vtkGenericOpenGLRenderWindow {
  public:
    static EglRenderWindow* New();

    void OpenGLInitContext() override {
        if (Initialized) return;
        {
            const QuietOutput quiet;
            vtkGenericOpenGLRenderWindow::OpenGLInitContext();
        }
        if (Initialized) return;
        GlewInitValid = Initialized = true;
        MaximumHardwareLineWidth = 1.0f;
        GetState()->Initialize(this);
    }

    vtkTypeMacro(EglRenderWindow, vtkGenericOpenGLRenderWindow)
};
vtkStandardNewMacro(EglRenderWindow);

void draw(MeshScene& scene, int width, int height, Pixels& pixels) {
    EglContext context;
    vtkNew<EglRenderWindow> window;
    vtkNew<vtkCallbackCommand> make_current, is_current;
    make_current->SetClientData(&context);
    make_current->SetCallback(
        [](vtkObject*, unsigned long, void* egl, void*) { static_cast<EglContext*>(egl)->make_current(); });
    is_current->SetClientData(&context);
    is_current->SetCallback([](vtkObject*, unsigned long, void* egl, void* answer) {
        *static_cast<bool*>(answer) = static_cast<EglContext*>(egl)->is_current();
    });
    window->AddObserver(vtkCommand::WindowMakeCurrentEvent, make_current);
    window->AddObserver(vtkCommand::WindowIsCurrentEvent, is_current);
    window->SetReadyForRendering(true);
    window->SetMultiSamples(0);
    window->SetSize(width, height);
    window->OpenGLInitContext();
    window->SetFrameBlitModeToNoBlit();
    window->AddRenderer(scene.renderer());
    window->Render();
    pixels.width = width;
    pixels.height = height;
    window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels.rgb, 0);
    window->RemoveRenderer(scene.renderer());
    scene.renderer()->SetRenderWindow(nullptr);
    window->Finalize();
}

/// Mean of blocks of factor × factor pixels.
void average(const Pixels& from, int factor, vtkImageData* image) {
    const int width = from.width / factor, height = from.height / factor;
    image->SetDimensions(width, height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
    const unsigned char* source = from.rgb->GetPointer(0);
    const int count = factor * factor;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                int sum = count / 2;
                for (int dy = 0; dy < factor; ++dy)
                    for (int dx = 0; dx < factor; ++dx)
                        sum +=
                            source[3 * (static_cast<std::size_t>(y * factor + dy) * from.width + x * factor + dx) + c];
                *to++ = static_cast<unsigned char>(sum / count);
            }
}

/// Scales the lines and texts of a scene for as long as it lives.
class ScaledOptions {
  public:
    ScaledOptions(MeshScene& scene, double factor) : scene_(scene), options_(scene.options()) {
        SceneOptions scaled = options_;
        scaled.pixel_ratio *= factor;
        scene_.set_options(scaled);
    }
    ~ScaledOptions() { scene_.set_options(options_); }
    ScaledOptions(const ScaledOptions&) = delete;
    ScaledOptions& operator=(const ScaledOptions&) = delete;

  private:
    MeshScene& scene_;
    SceneOptions options_;
};

}  // namespace

void render_png(MeshScene& scene, int width, int height, const std::filesystem::path& file) {
    if (width < 1 || height < 1 || width > max_side || height > max_side)
        throw Unsupported(fmt::format("A picture of {}×{} pixels cannot be drawn; 1×1 to {}×{} can.", width, height,
                                      max_side, max_side));
    if (scene.renderer()->GetRenderWindow())
        throw Unsupported("The scene is shown in a window and cannot be drawn without one at the same time.");
    const int factor = 2 * std::max(width, height) <= max_drawn_side ? 2 : 1;
    Pixels pixels;
    {
        const ScaledOptions scaled(scene, factor);
        std::exception_ptr failure;
        // A thread of its own has no current context of somebody else's (a toolkit's) that ours could disturb.
        std::thread([&] {
            try {
                draw(scene, factor * width, factor * height, pixels);
            } catch (...) {
                failure = std::current_exception();
            }
        }).join();
        if (failure) std::rethrow_exception(failure);
    }
    vtkNew<vtkImageData> image;
    average(pixels, factor, image);
    AtomicFile target(file);
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(target.path().c_str());
    writer->SetInputData(image);
    {
        const QuietOutput quiet;
        writer->Write();
    }
    if (writer->GetErrorCode() != 0)
        throw InvalidInput(file.string(), 0, "The picture cannot be written; the folder must exist and be writable.");
    target.commit();
}

}  // namespace curvewright
