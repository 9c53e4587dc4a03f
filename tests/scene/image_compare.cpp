#include "tests/scene/image_compare.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

namespace curvewright {

std::filesystem::path temporary_picture(const std::string& name) {
    struct Files {
        std::vector<std::filesystem::path> paths;
        ~Files() {
            std::error_code ignored;
            for (const auto& path : paths) std::filesystem::remove(path, ignored);
        }
    };
    static Files files;
    files.paths.push_back(std::filesystem::temp_directory_path() /
                          ("curvewright_" + name + "_" + std::to_string(::getpid()) + ".png"));
    return files.paths.back();
}

Image read_image(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) throw std::runtime_error(file.string() + " is missing");
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkImageData* data = reader->GetOutput();
    if (data->GetNumberOfScalarComponents() != 3 || data->GetScalarType() != VTK_UNSIGNED_CHAR)
        throw std::runtime_error(file.string() + " is not a picture with three channels");
    Image image;
    image.width = data->GetDimensions()[0];
    image.height = data->GetDimensions()[1];
    const auto* bytes = static_cast<const unsigned char*>(data->GetScalarPointer());
    image.rgb.assign(bytes, bytes + 3 * image.width * image.height);
    return image;
}

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height) return {255.0, 1.0};
    double sum = 0.0;
    long far = 0;
    for (std::size_t pixel = 0; pixel < a.rgb.size() / 3; ++pixel) {
        int largest = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const int difference = std::abs(a.rgb[3 * pixel + c] - b.rgb[3 * pixel + c]);
            sum += difference;
            largest = std::max(largest, difference);
        }
        if (largest > 24) ++far;
    }
    return {sum / static_cast<double>(a.rgb.size()),
            3.0 * static_cast<double>(far) / static_cast<double>(a.rgb.size())};
}

bool is_same(const ImageDifference& difference) {
    return difference.mean <= largest_mean && difference.far_pixels <= most_far_pixels;
}

}  // namespace curvewright
