#include "benchmarks/cases/timed.h"
#include "benchmarks/untangle_tables/measurements.h"
#include "core/quality/jacobian_bounds.h"
#include "tests/support/mesh_factory.h"

namespace curvewright::benchmarks {
namespace {

/// Elements per second, on one thread.
double certified_per_second(ElementType type, double amplitude) {
    std::mt19937 random(1);
    std::vector<Eigen::MatrixX3d> elements;
    for (int i = 0; i < 64; ++i) elements.push_back(testing::random_element(type, amplitude, random));
    JacobianBounds bounds(type);
    const int rounds = type.shape == Shape::hexahedron ? 20 : 500;
    volatile double keep = 0.0;
    const auto best = best_of([&] {
        return timed([&] {
            for (int i = 0; i < rounds; ++i)
                for (const auto& element : elements) keep = bounds.bound(element, 1.0, {}).scaled_jacobian;
            return 0;
        });
    });
    return static_cast<double>(rounds) * static_cast<double>(elements.size()) / best.seconds;
}

}  // namespace

void measure_certification(const Settings&, Report& report) {
    Table table{"certification",
                "Certification",
                "Elements whose scaled Jacobian is bounded from both sides per second, on one core. Straight: no "
                "subdivision. Curved: random displacements of a tenth of the size, with the subdivisions they need.",
                {"element", "P", "straight, 1/s", "curved, 1/s"},
                {}};
    const auto rounded = [](double rate) { return static_cast<long long>(rate / 1000.0 + 0.5) * 1000; };
    const auto measure = [&](const char* name, Shape shape, int order) {
        tell(fmt::format("certification: {} P{}", name, order));
        const double straight = certified_per_second({shape, order}, 0.0);
        table.add({name, order, rounded(straight), rounded(certified_per_second({shape, order}, 0.1))});
        return straight;
    };
    double triangles = 0.0, tetrahedra = 0.0;
    for (int order : {2, 3, 4}) {
        const double rate = measure("triangle", Shape::triangle, order);
        if (order == 3) triangles = rate;
    }
    for (int order : {2, 3, 4}) {
        const double rate = measure("tetrahedron", Shape::tetrahedron, order);
        if (order == 3) tetrahedra = rate;
    }
    measure("quadrilateral", Shape::quadrilateral, 3);
    measure("hexahedron", Shape::hexahedron, 3);
    measure("prism", Shape::prism, 3);
    report.add(table);
    report.add({"certified P3 triangles per second and core", "≥ 2 million",
                fmt::format("{:.2f} million", triangles / 1e6), triangles >= 2e6});
    report.add({"certified P3 tetrahedra per second and core", "≥ 150,000", fmt::format("{:.0f},000", tetrahedra / 1e3),
                tetrahedra >= 150e3});
}

}  // namespace curvewright::benchmarks
