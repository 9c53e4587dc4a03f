#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/command.h"
#include "app/cli/global_check.h"
#include "app/cli/node_options.h"
#include "app/cli/output.h"
#include "app/cli/target.h"
#include "app/cli/untangle_outcome.h"
#include "app/cli/untangle_report.h"
#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/quality/shape_quality.h"
#include "core/report/report_files.h"
#include "core/untangle/trace.h"
#include "core/warp/straight_start.h"

namespace curvewright::cli {
namespace {

constexpr const char* guaranteed_method = "guaranteed";
constexpr const char* signed_method = "signed-angle";
constexpr const char* unsigned_method = "unsigned-angle";

struct Options {
    InputOptions input;
    std::filesystem::path trace, report;
    bool has_report = false;  ///< an empty name is one, though a bad one
    OutputOptions output;
    std::string method = guaranteed_method;
    SignedAngleOptions signed_angles;
    bool is_literal = false;  ///< unsigned angles to the letter
    int max_passes = 0;       ///< 0 = the method's own
    std::optional<Weighting> warp_first;
    GuaranteedOptions guaranteed;
    bool has_target = false;
    std::vector<std::string> boundary;  ///< rules as given
    NodeArguments nodes;
    bool keeps_best = false;

    UntangleOptions of_method(const MeshTopology& topology) const;
};

/// What all methods take.
template <class MethodOptions>
MethodOptions with_common(MethodOptions its, const Options& options, const MeshTopology& topology) {
    its.nodes = options.nodes.rules(topology);
    its.keeps_best_on_cancel = options.keeps_best;
    return its;
}

UntangleOptions Options::of_method(const MeshTopology& topology) const {
    if (method == guaranteed_method) {
        GuaranteedOptions options = with_common(guaranteed, *this, topology);
        for (const std::string& rule : boundary) options.boundary.add(rule);
        return options;
    }
    if (method == signed_method) {
        SignedAngleOptions options = with_common(signed_angles, *this, topology);
        if (max_passes > 0) options.max_passes = max_passes;
        return options;
    }
    UnsignedAngleOptions options =
        with_common(is_literal ? UnsignedAngleOptions::literal() : UnsignedAngleOptions(), *this, topology);
    if (max_passes > 0) options.max_passes = max_passes;
    return options;
}

/// A trace file that becomes visible when it is complete.
class TraceFile {
  public:
    explicit TraceFile(const std::filesystem::path& file)
        : name_(file.string()), file_(file), stream_(file_.path()), writer_(stream_) {
        if (!stream_) throw InvalidInput(file.string(), 0, "the file cannot be written.");
    }
    UntangleObserver* observer() { return &writer_; }
    void commit() {
        stream_.close();
        if (!stream_) throw InvalidInput(name_, 0, "the trace could not be written completely (is the disk full?).");
        file_.commit();
    }

  private:
    std::string name_;
    AtomicFile file_;
    std::ofstream stream_;
    TraceWriter writer_;
};

Json shape_json(const ShapeSummary& shape) {
    return {{"min", shape.min}, {"mean", shape.mean}};
}

/// Refuses options that the method chosen does not read. of: the options of each method but the common ones.
void check_options(const CLI::App& command, const std::string& method,
                   const std::map<std::string, std::vector<std::string>>& methods_of) {
    for (const auto& [option, methods] : methods_of)
        if (command.count(option) > 0 && std::find(methods.begin(), methods.end(), method) == methods.end())
            throw CLI::ValidationError(
                option, fmt::format("is for --method {}, not for {}", fmt::join(methods, " or "), method));
}

/// Files beside the report's that must not be in its way.
std::vector<std::filesystem::path> report_neighbours(const Options& options) {
    std::vector<std::filesystem::path> files{options.input.file, options.output.file};
    if (!options.trace.empty()) files.push_back(options.trace);
    return files;
}

/// What became of a mesh that was valid.
void note_unchanged(const Target& target, const TargetOutcome& outcome, bool are_all_assessed, Work& work) {
    const std::string none = are_all_assessed ? "No element is tangled" : "No element that was assessed is tangled";
    if (!target.is_explicit)
        work.note(none + "; nothing was changed. `improve` raises the quality of a valid mesh.");
    else if (outcome.is_reached())
        work.note(fmt::format("{}, and all reach the target {:g}; nothing was changed.", none, target.value));
    else
        work.note(fmt::format(
            "{}; nothing was changed. {} below the target {:g} (the least is {:.4g}); `improve --target {:g}` "
            "raises the quality of a valid mesh.",
            none, outcome.below == 1 ? "1 element is" : fmt::format("{} elements are", outcome.below), target.value,
            outcome.least, target.value));
}

/// Notes how the result stands to the target, if it is valid; the status that follows.
int note_outcome(const Options& options, bool was_valid, const QualityReport& after, Work& work) {
    const int validity = validity_status(after.summary);
    const Target target{options.guaranteed.target, options.has_target};
    const TargetOutcome outcome = compare(target, scaled_jacobians(after));
    if (was_valid) {
        note_unchanged(target, outcome, after.summary.not_assessed == 0, work);
        return target.is_explicit && !outcome.is_reached() ? exit_less_than_asked : validity;
    }
    const bool has_target = options.method == guaranteed_method && options.guaranteed.improves;
    return validity != exit_done || !has_target ? validity : note_target(target, outcome, work);
}

int run(const Options& options, Work& work) {
    check_output(options.output);
    if (options.has_report) check_report_folder(options.report, report_neighbours(options));
    const ReadResult read = read_input(options.input, work);
    const CurvedMesh& input = read.mesh;
    const QualityReport before = certify(input, work);
    note_assessment(input.topology(), before, work);
    std::optional<TraceFile> trace;
    ConvergenceLog log;
    ObserverFan observers;
    if (!options.trace.empty()) observers.add(trace.emplace(options.trace).observer());
    if (options.has_report) observers.add(&log);

    const UntangleOptions of_method = options.of_method(input.topology());
    const bool was_valid = before.summary.invalid + before.summary.undecided == 0;
    // A valid mesh is not changed.
    const std::string warped_first = options.warp_first && !was_valid ? to_string(*options.warp_first) : "";
    CurvedMesh start = input;
    if (!warped_first.empty()) {
        WarpOptions warp;
        warp.weighting = *options.warp_first;
        start = input.with_coordinates(warp_from_straight(input, warp, work.context()).coordinates);
        work.end_phase("warp");
    }
    const UntangleRun result = run_untangling(start, of_method, observers.observer(), work.context());
    work.end_phase("prepare", result.timings);
    if (options.keeps_best) work.ignore_stop();
    const CurvedMesh mesh = input.with_coordinates(result.coordinates);
    const QualityReport after = certify_result(mesh, before, work);
    const bool is_cancelled = result.reason == StopReason::cancelled;
    if (is_cancelled && !note_cancelled(after, options.output.file, work)) return exit_cancelled;
    const GlobalCheck global(mesh, after, work);
    const ShapeSummary shape_before = assess_shape(input, input.coordinates(), work.context());
    const ShapeSummary shape = assess_shape(mesh, input.coordinates(), work.context());
    work.end_phase("shape");
    std::unique_ptr<ReportFiles> report;
    if (options.has_report) {
        const UntangleFacts facts{options.input.file, input, before, mesh, after, of_method, warped_first, result, log};
        report = write_report(options.report, facts, work);
    }
    if (trace) trace->commit();
    write_output(options.output, mesh, read.fields, &after, &input.coordinates(), work);
    if (report) report->commit();

    note_unmended(input.topology(), result, work);
    const int status = note_outcome(options, was_valid, after, work);
    if (work.is_json()) {
        Json json = {{"mesh", mesh_json(options.output.file, mesh)}};
        json.update(run_json(input.topology(), of_method, warped_first, result));
        json.update(
            {{"orientation", to_string(before.orientation)},
             {"scaled_jacobian", summary_json(after.summary)},
             {"shape", shape_json(shape)},
             {"before", {{"scaled_jacobian", summary_json(before.summary)}, {"shape", shape_json(shape_before)}}},
             {"worst", worst_json(mesh, after)}});
        global.add_to(json, mesh);
        if (report) json["report"] = options.report.string();
        work.print(json);
    } else {
        fmt::print("{}: {}\n", options.output.file.string(), mesh_line(mesh));
        fmt::print("before  {}\nafter   {}\n", summary_line(before.summary), summary_line(after.summary));
        fmt::print("{}\n", run_text(of_method, result, work.timings()));
        fmt::print("{}\n", global.line());
        if (report) fmt::print("report  {}\n", (options.report / report_html_name).string());
    }
    return is_cancelled ? exit_cancelled : worse_status(status, global.status());
}

}  // namespace

void add_untangle(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "untangle",
                                "Make invalid elements valid; the boundary stays unless told otherwise");
    auto options = std::make_shared<Options>();
    add_input_option(*command, options->input);
    add_output_options(*command, options->output);
    options->signed_angles.beta_choice = BetaChoice::automatic;
    command
        ->add_option("--method", options->method,
                     "guaranteed (default; signed-angle with --beta), signed-angle or unsigned-angle")
        ->check(CLI::IsMember({guaranteed_method, signed_method, unsigned_method}));
    command
        ->add_option_function<std::string>(
            "--beta",
            [options](const std::string& beta) {
                SignedAngleOptions& signed_angles = options->signed_angles;
                signed_angles.beta_choice = beta == "auto" ? BetaChoice::automatic : BetaChoice::given;
                if (beta != "auto") signed_angles.beta = std::strtod(beta.c_str(), nullptr);
            },
            "Weight of the angles against the displacement, in (0, 1], small for stretched layers; auto (default): the "
            "best for every edge (signed-angle)")
        ->check([](const std::string& text) {
            char* end = nullptr;
            const double beta = std::strtod(text.c_str(), &end);
            const bool is_number = end != text.c_str() && *end == '\0' && beta > 0.0 && beta <= 1.0;
            return is_number || text == "auto" ? std::string() : "beta must be auto, or greater than 0 and at most 1";
        })
        ->type_name("B|auto");
    command->add_flag_function(
        "--length-normalised",
        [options](std::int64_t) { options->signed_angles.displacement = DisplacementUnit::edge_length; },
        "Measure displacements in lengths of the node's edge, so that beta does not depend on the unit of length "
        "(signed-angle; always so with --beta auto)");
    command
        ->add_option_function<std::string>(
            "--warp-first",
            [options](const std::string& weights) {
                for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic})
                    if (weights == to_string(weighting)) options->warp_first = weighting;
            },
            "Begin with the interior nodes, corners included, where these weights of the straight-sided mesh put them "
            "(signed-angle, which moves high-order nodes only)")
        ->check(CLI::IsMember({"convex", "affine", "elastic"}));
    command->add_option("--max-passes", options->max_passes, "Passes at most (signed-angle, unsigned-angle)")
        ->check(CLI::Range(1, 1000000));
    command->add_flag("--literal", options->is_literal,
                      "The method as published: one start and one first step for every edge (unsigned-angle)");
    command->add_flag("--reject-worse-pass", options->signed_angles.reject_worse_pass,
                      "Take back a pass that lowers the certified quality, and stop there (signed-angle)");
    command->add_option("--trace", options->trace, "Write every step to this file, one JSON object per line")
        ->type_name("FILE.jsonl");
    command
        ->add_option("--report", options->report,
                     "Write report.html and report.json into this folder: the outcome with pictures, and how it went")
        ->type_name("DIR");
    add_target_option(*command, options->guaranteed.target,
                      "Elements below this scaled Jacobian are improved once all are valid (guaranteed)");
    command
        ->add_option(
            "--boundary", options->boundary,
            "What boundary nodes may do: fixed (default), slide along the boundary as it was read, or free; for all or "
            "for a group; may be given several times (guaranteed)")
        ->type_name("MODE|GROUP=MODE");
    command
        ->add_option("--shape-floor", options->guaranteed.shape_floor,
                     "Worst mean ratio that improving may leave, where that can be had; 0 = none (guaranteed)")
        ->type_name("F")
        ->check(CLI::Range(0.0, 0.999));
    command->add_flag("!--valid-only", options->guaranteed.improves,
                      "Stop as soon as all elements are valid (guaranteed)");
    add_node_options(*command, options->nodes);
    add_keep_best_option(*command, options->keeps_best);
    command->parse_complete_callback([command, options] {
        options->has_report = command->count("--report") > 0;
        options->has_target = command->count("--target") > 0;
        // A beta alone says which method is meant.
        if (command->count("--method") == 0 && command->count("--beta") > 0) options->method = signed_method;
        check_options(*command, options->method,
                      {{"--beta", {signed_method}},
                       {"--length-normalised", {signed_method}},
                       {"--warp-first", {signed_method}},
                       {"--reject-worse-pass", {signed_method}},
                       {"--max-passes", {signed_method, unsigned_method}},
                       {"--literal", {unsigned_method}},
                       {"--target", {guaranteed_method}},
                       {"--boundary", {guaranteed_method}},
                       {"--shape-floor", {guaranteed_method}},
                       {"--valid-only", {guaranteed_method}}});
        if (options->warp_first && (options->nodes.keeps_vertices || !options->nodes.fixed.empty()))
            throw CLI::ValidationError("--warp-first",
                                       "moves every interior node, so it excludes --keep-vertices and --fix-nodes");
    });
    set_action(*command, invocation, options, run);
}

}  // namespace curvewright::cli
