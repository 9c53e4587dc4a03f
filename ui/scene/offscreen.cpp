#include "ui/scene/offscreen.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLState.h>
#include <vtkPNGWriter.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "ui/scene/egl_context.h"
#include "ui/scene/picture_pixels.h"
#include "ui/scene/quiet_output.h"

namespace curvewright {
namespace {

constexpr int max_side = 8192;        ///< of what is asked for
constexpr int max_drawn_side = 8192;  ///< of what is drawn before averaging, where the picture allows it

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

/// On grounds of the given colours, one picture each: 3 bytes per pixel, rows from the bottom.
std::vector<vtkSmartPointer<vtkUnsignedCharArray>> draw(MeshScene& scene, int width, int height,
                                                        const std::vector<Color>& grounds) {
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
    std::vector<vtkSmartPointer<vtkUnsignedCharArray>> pictures;
    for (const Color& ground : grounds) {
        scene.renderer()->SetBackground(ground[0], ground[1], ground[2]);
        window->Render();
        pictures.push_back(vtkSmartPointer<vtkUnsignedCharArray>::New());
        window->GetPixelData(0, 0, width - 1, height - 1, 0, pictures.back(), 0);
    }
    window->RemoveRenderer(scene.renderer());
    scene.renderer()->SetRenderWindow(nullptr);
    window->Finalize();
    return pictures;
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

vtkSmartPointer<vtkImageData> image_of(const PicturePixels& pixels, int width, int height) {
    const auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(width, height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, pixels.channels);
    std::copy(pixels.bytes.begin(), pixels.bytes.end(), static_cast<unsigned char*>(image->GetScalarPointer()));
    return image;
}

}  // namespace

PicturePixels render_pixels(MeshScene& scene, int width, int height, PictureGround ground) {
    if (width < 1 || height < 1 || width > max_side || height > max_side)
        throw Unsupported(fmt::format("A picture of {}×{} pixels cannot be drawn; 1×1 to {}×{} can.", width, height,
                                      max_side, max_side));
    if (scene.renderer()->GetRenderWindow())
        throw Unsupported("The scene is shown in a window and cannot be drawn without one at the same time.");
    const int factor = 2 * std::max(width, height) <= max_drawn_side ? 2 : 1;
    const bool is_transparent = ground == PictureGround::transparent;
    const std::vector<Color> grounds =
        is_transparent ? std::vector<Color>{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}} : std::vector{scene.options().background};
    std::vector<vtkSmartPointer<vtkUnsignedCharArray>> drawn;
    {
        const ScaledOptions scaled(scene, factor);
        std::exception_ptr failure;
        // A thread of its own has no current context of somebody else's (a toolkit's) that ours could disturb.
        std::thread([&] {
            try {
                drawn = draw(scene, factor * width, factor * height, grounds);
            } catch (...) {
                failure = std::current_exception();
            }
        }).join();
        if (failure) std::rethrow_exception(failure);
    }
    return is_transparent ? without_ground(drawn[0]->GetPointer(0), drawn[1]->GetPointer(0), factor * width,
                                           factor * height, factor)
                          : average(drawn[0]->GetPointer(0), factor * width, factor * height, factor);
}

void render_png(MeshScene& scene, int width, int height, const std::filesystem::path& file, PictureGround ground) {
    const vtkSmartPointer<vtkImageData> image = image_of(render_pixels(scene, width, height, ground), width, height);
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

std::string draw_png(MeshScene& scene, int width, int height, PictureGround ground) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(image_of(render_pixels(scene, width, height, ground), width, height));
    writer->WriteToMemoryOn();
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    const unsigned char* begin = bytes->GetPointer(0);
    return {begin, begin + bytes->GetNumberOfTuples()};
}

}  // namespace curvewright
