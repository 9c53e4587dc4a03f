#include <algorithm>
#include <cmath>

#include <Eigen/SparseLU>

#include "benchmarks/cases/timed.h"
#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/warp_times.h"
#include "core/base/error.h"
#include "core/warp/equations.h"

namespace curvewright::benchmarks {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// D_I of (2.5) in the order of the mesh's nodes, convex weights as published.
Matrix natural_matrix(const WarpCase& problem) {
    const CurvedMesh& mesh = problem.mesh;
    const std::vector<Index>& interior = mesh.topology().interior_nodes();
    std::vector<Index> number_of(static_cast<std::size_t>(mesh.topology().node_count()), -1);
    for (std::size_t i = 0; i < interior.size(); ++i)
        number_of[static_cast<std::size_t>(interior[i])] = static_cast<Index>(i);
    const NeighbourSets sets = find_neighbours(mesh.topology(), interior);
    const WeightTable table = compute_weights(mesh, sets, convex_weighting(0.0));
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < interior.size(); ++i) {
        const auto row = static_cast<Index>(i);
        entries.emplace_back(row, row, 1.0);
        for (std::size_t k = sets.offsets[i]; k < sets.offsets[i + 1]; ++k)
            if (const Index column = number_of[static_cast<std::size_t>(sets.nodes[k])]; column >= 0)
                entries.emplace_back(row, column, -table.weights[k]);
    }
    const auto n = static_cast<Index>(interior.size());
    Matrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Index bandwidth(const Matrix& matrix) {
    Index width = 0;
    for (int column = 0; column < matrix.outerSize(); ++column)
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry)
            width = std::max(width, static_cast<Index>(std::abs(entry.row() - entry.col())));
    return width;
}

/// One square per bin that has an entry, those of a row joined; few enough bins for a small file.
std::string spy_plot(const Matrix& matrix, const std::string& title) {
    constexpr int bins = 220, scale = 3, margin = 34;
    std::vector<bool> has_entry(bins * bins, false);
    const double step = static_cast<double>(matrix.rows()) / bins;
    for (int column = 0; column < matrix.outerSize(); ++column)
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry)
            has_entry[static_cast<std::size_t>(static_cast<int>(entry.row() / step) * bins +
                                               static_cast<int>(entry.col() / step))] = true;
    std::string path;
    for (int row = 0; row < bins; ++row)
        for (int column = 0; column < bins;) {
            int end = column;
            while (end < bins && has_entry[static_cast<std::size_t>(row * bins + end)]) ++end;
            if (end > column) path += fmt::format("M{} {}h{}v1h-{}z", column, row, end - column, end - column);
            column = std::max(end, column + 1);
        }
    constexpr int side = bins * scale;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
        "aria-label=\"{2}\">\n<style>.paper {{ fill: #ffffff }} .entry {{ fill: #1668b0 }} .frame {{ fill: none; "
        "stroke: "
        "#6b7280 }} text {{ fill: #1f2328; font: 600 16px sans-serif }} @media (prefers-color-scheme: dark) {{ .paper "
        "{{ "
        "fill: #14181d }} .entry {{ fill: #6db7f5 }} .frame {{ stroke: #8b949e }} text {{ fill: #e6edf3 }} }}</style>\n"
        "<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>\n<text x=\"10\" y=\"23\">{2}</text>\n"
        "<path class=\"entry\" transform=\"translate(10 {3}) scale({4})\" d=\"{5}\"/>\n"
        "<rect class=\"frame\" x=\"10\" y=\"{3}\" width=\"{6}\" height=\"{6}\"/>\n</svg>\n",
        side + 20, side + margin + 10, title, margin, scale, path, side);
}

struct Factored {
    double seconds = 0.0;
    Matrix reordered;   ///< rows and columns in the order in which SparseLU eliminates them
    Index entries = 0;  ///< of L and U
};

template <class Ordering>
Factored factored(const Matrix& matrix) {
    Factored result;
    const Stopwatch watch;
    Eigen::SparseLU<Matrix, Ordering> lu(matrix);
    result.seconds = watch.seconds();
    if (lu.info() != Eigen::Success) throw SolverFailure("SparseLU could not factor the matrix of figure 2.1.");
    result.reordered = lu.rowsPermutation() * matrix * lu.colsPermutation().inverse();
    result.entries = static_cast<Index>(lu.nnzL() + lu.nnzU());
    return result;
}

}  // namespace

void measure_sparsity(const Settings& settings, ThesisReport& report) {
    if (!settings.wants("figure", "2.1")) return;
    tell("figure 2.1");
    const WarpCase problem = sample_warp_case(settings.samples, "moving_circles1");
    const Matrix matrix = natural_matrix(problem);
    const auto colamd = best_of([&] { return factored<Eigen::COLAMDOrdering<int>>(matrix); }, settings.repeats());
    Comparison table(
        {"figure", "2.1"}, "the matrix of the third example",
        "The matrix D_I of \"Moving circles 1\". The thesis shows the two plots without numbers. Literal: (a) "
        "the order of the mesh's nodes, (b) rows and columns as SparseLU with COLAMD eliminates them. Best: "
        "this program's solver needs no factors; its time is that of a whole warp without neighbours and "
        "weights.",
        "order", {"rows", "entries", "bandwidth", "entries of L and U", "s"});
    const auto n = static_cast<Index>(matrix.rows());
    const auto entries = static_cast<Index>(matrix.nonZeros());
    table.expect("natural");
    table.expect("COLAMD");
    if (settings.is_quick) {
        table.add(By::literal, "natural", "SparseLU", {n, entries, bandwidth(matrix)},
                  "factorisation left out by --quick: half a minute");
    } else {
        const auto natural = factored<Eigen::NaturalOrdering<int>>(matrix);
        table.add(By::literal, "natural", "SparseLU",
                  {n, entries, bandwidth(matrix), natural.entries, natural.seconds});
    }
    table.add(By::literal, "COLAMD", "SparseLU",
              {n, entries, bandwidth(colamd.reordered), colamd.entries, colamd.seconds});
    const TimedWarp own = best_of([&] { return timed_warp(problem); }, settings.repeats());
    table.add(
        By::best, "along a space-filling curve", "multilevel",
        {n - own.result.report.condensed_nodes, Cell(), Cell(), Cell(), own.remaining_seconds()},
        fmt::format("{} nodes inside elements are eliminated first", Cell(own.result.report.condensed_nodes).shown));
    report.add(table, std::vector<Picture>{
                          {"figure_2.1a", "Figure 2.1 (a): natural ordering", spy_plot(matrix, "(a) natural ordering")},
                          {"figure_2.1b", "Figure 2.1 (b): reordered with column AMD",
                           spy_plot(colamd.reordered, "(b) reordered with column AMD")}});
}

}  // namespace curvewright::benchmarks
