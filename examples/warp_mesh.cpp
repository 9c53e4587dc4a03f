// Warps a mesh after the deformation of its boundary: warp_mesh MESH DEFORMATION OUTPUT
// For instance: warp_mesh moving_circle.msh deformation.json warped.vtu
//
// Exit status: 0 the result is valid; 1 bad input or a file that cannot be used; 2 wrong usage; 3 the result was
// written, but elements are invalid or undecided.

#include <csignal>
#include <cstdio>
#include <exception>
#include <stop_token>
#include <string>
#include <string_view>

#include <curvewright/curvewright.h>

namespace {

using namespace curvewright;

std::stop_source stop;

/// Ctrl+C asks the work to stop; a second one ends the program at once.
void on_interrupt(int signal) {
    std::signal(signal, SIG_DFL);
    stop.request_stop();
}

/// Where the work can be stopped from and whom it tells how far it is: here, one line per phase.
TaskContext make_context() {
    TaskContext context;
    context.stop = stop.get_token();
    context.progress = [last = std::string()](std::string_view phase, double /*fraction*/) mutable {
        if (phase == last) return;
        last = phase;
        std::fprintf(stderr, "%s\n", last.c_str());
    };
    return context;
}

void print_quality(const char* when, const QualitySummary& quality) {
    std::printf("%-6s  scaled Jacobian: min %.4f, mean %.4f; %d valid, %d invalid, %d undecided\n", when, quality.min,
                quality.mean, quality.valid, quality.invalid, quality.undecided);
}

/// True if every element of the result is proved valid.
bool warp_file(const std::string& mesh_file, const std::string& deformation_file, const std::string& output_file) {
    const TaskContext context = make_context();
    const CurvedMesh mesh = read_mesh(mesh_file, context).mesh;
    const Deformation deformation = read_deformation(deformation_file, context);

    // The certified quality: proved bounds, so that "valid" is not a matter of where one samples.
    const QualityReport before = assess_quality(mesh, {}, context);
    print_quality("before", before.summary);

    // Where the boundary goes, and the interior after it. Interfaces inside the domain may be moved, too.
    WarpOptions options;
    options.prescribed_nodes = prescribed_interior_nodes(mesh, deformation);
    const WarpResult warped = warp(mesh, apply_deformation(mesh, deformation), options, context);
    const CurvedMesh result = mesh.with_coordinates(warped.coordinates);

    // The result is judged by the orientation of the original: a mesh that was turned inside out is not valid.
    QualityOptions same_orientation;
    same_orientation.orientation_sign = before.orientation_sign;
    const QualityReport after = assess_quality(result, same_orientation, context);
    print_quality("after", after.summary);

    // With the quality and the displacement as arrays, for ParaView.
    WriteOptions output;
    output.quality = &after;
    output.reference = &mesh.coordinates();
    write_mesh(output_file, result, output);
    return after.summary.valid == after.summary.elements();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "Usage: warp_mesh MESH DEFORMATION OUTPUT\n");
        return 2;
    }
    std::signal(SIGINT, on_interrupt);
    try {
        return warp_file(argv[1], argv[2], argv[3]) ? 0 : 3;
    } catch (const Cancelled&) {
        std::fprintf(stderr, "Cancelled; nothing was written.\n");
    } catch (const std::exception& error) {  // curvewright::Error says in one sentence what is wrong, and where
        std::fprintf(stderr, "%s\n", error.what());
    }
    return 1;
}
