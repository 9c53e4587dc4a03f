#include <array>

#include "benchmarks/cases/timed.h"
#include "benchmarks/untangle_tables/measurements.h"
#include "core/quality/quality.h"

namespace curvewright::benchmarks {
namespace {

/// The same problem in another unit and with another origin.
UntangleCase transformed(const UntangleCase& problem, double factor, double shift) {
    const auto apply = [&](const Coordinates& x) {
        Coordinates y = x * factor;
        y.leftCols(problem.mesh.topology().dimension()).array() += shift;
        return y;
    };
    return {problem.name, problem.mesh.with_coordinates(apply(problem.mesh.coordinates())), apply(problem.ideal)};
}

}  // namespace

void measure_invariance(const Settings& settings, Report& report) {
    Table table{
        "untangle_invariance",
        "Unit and origin",
        "The guaranteed method, default setting, on the same mesh in other coordinates: difference of the least "
        "scaled Jacobian from that of the mesh as it is. A shift by a million sizes leaves ten digits of the input, "
        "and the method the same amount of noise to live with.",
        {"case", "least", "× 1e-6", "× 1e6", "× 2^20", "shifted by 1e6 sizes"},
        {}};
    double worst_scale = 0.0, worst_shift = 0.0;
    bool is_exact = true, is_valid = true;
    for (const ThesisCase& entry : thesis_cases(settings)) {
        tell("invariance: " + entry.name);
        const UntangleCase problem = load_case(settings, entry.name);
        const double size =
            (problem.ideal.colwise().maxCoeff() - problem.ideal.colwise().minCoeff()).cwiseAbs().maxCoeff();
        const auto least = [&](const UntangleCase& other) {
            const Judgement result = judge(other, timed_guaranteed(other, true).result.coordinates);
            is_valid = is_valid && result.invalid == 0;
            return result.min;
        };
        const double here = least(problem);
        const std::array<double, 4> differences{
            least(transformed(problem, 1e-6, 0.0)) - here, least(transformed(problem, 1e6, 0.0)) - here,
            least(transformed(problem, 0x1p20, 0.0)) - here, least(transformed(problem, 1.0, 1e6 * size)) - here};
        std::vector<Cell> row{entry.name, here};
        for (double difference : differences) row.push_back(formatted(difference, "{:.1e}"));
        table.add(row);
        worst_scale = std::max({worst_scale, std::abs(differences[0]), std::abs(differences[1])});
        worst_shift = std::max(worst_shift, std::abs(differences[3]));
        is_exact = is_exact && differences[2] == 0.0;
    }
    report.add(table);
    report.add({"guaranteed: other unit or origin", "valid, and the same up to rounding",
                fmt::format("{}; differences ≤ {:.0e} (unit), ≤ {:.0e} (origin){}", is_valid ? "valid" : "not valid",
                            worst_scale, worst_shift, is_exact ? ", none for powers of two" : ""),
                is_valid && worst_scale < 1e-3 && worst_shift < 1e-2});
}

}  // namespace curvewright::benchmarks
