#include "benchmarks/thesis/published.h"

namespace curvewright::benchmarks::published {
namespace {

// A line of the thesis is a line here.
// clang-format off
const std::vector<FamilyLevel> circle{
    {0, 437, 920, 830, 2035, 1900},
    {1, 842, 1749, 1621, 3886, 3694},
    {2, 1747, 3584, 3406, 7996, 7729},
    {3, 3725, 7586, 7316, 16966, 16561},
    {4, 7848, 15891, 15503, 35608, 35026},
    {5, 14914, 30091, 29567, 67507, 66721},
    {6, 28287, 56320, 56084, 127579, 126466,
     "inconsistent in the thesis: by Euler's formula its other columns belong to 28,227 elements and 56,826 nodes of "
     "order 2; 56,320 stands in table 2.2 as well"},
    {7, 58221, 116966, 115920, 262780, 261211},
    {8, 117001, 234742, 233264, 527614, 525397},
};

const std::vector<FamilyLevel> sphere{
    {0, 536, 1028, 454, 3096, 1807},
    {1, 1161, 2056, 1094, 6346, 4184},
    {2, 2231, 3716, 2274, 11691, 8449},
    {3, 4393, 7080, 4662, 22508, 17070},
    {4, 9483, 14668, 10554, 47251, 37997},
    {5, 19208, 28903, 22053, 93942, 78532},
    {6, 38618, 56320, 45890, 184935, 161470},
    {7, 76338, 109333, 92475, 361165, 323237},
};

constexpr const char* shell_order =
    "inconsistent in the thesis: the captions of its figures say second order; the numbers of nodes are those of third";

const std::vector<WarpExample> warps{
    {"naca_p2", "NACA0012 airfoil", "2.4", 2384, 2, 4610,
     0.0052, 0.0412, 0.0631, 0.1060, 0.0628, {0.163, 0.998, 1.000}, {0.169, 0.998, 1.000}},
    {"moving_circle", "Moving circle", "2.5", 1686, 2, 3232,
     0.0034, 0.0224, 0.0346, 0.0700, 0.0342, {0.453, 0.952, 1.000}, {0.454, 0.953, 1.000}},
    {"moving_circles1", "Moving circles 1", "2.6", 1498, 3, 6558,
     0.0085, 0.0970, 0.1226, 0.3142, 0.1220, {0.109, 0.867, 0.997}, {0.137, 0.881, 0.997}},
    {"moving_circles2", "Moving circles 2", "2.7", 1498, 3, 6558,
     0.0085, 0.0970, 0.1220, 0.3156, 0.1222, {0.124, 0.915, 0.997}, {0.137, 0.923, 0.997}},
    {"screw", "Screw", "2.8", 615, 2, 402,
     0.0022, 0.0078, 0.0043, 0.0418, 0.0030, {0.008, 0.894, 0.996}, {0.008, 0.901, 0.998}},
    {"moving_sphere", "Moving sphere", "2.9", 19207, 3, 76175,
     0.3917, 23.9505, 310.7020, 50.2970, 310.6000, {0.173, 0.934, 1.000}, {0.543, 0.946, 1.000}},
    {"moving_spheres", "Moving spheres", "2.10", 51533, 2, 59104,
     0.2435, 8.3268, 168.9980, 13.0349, 169.2470, {0.120, 0.966, 1.000}, {0.153, 0.967, 1.000}},
    {"shell1", "Shell 1", "2.11", 8914, 3, 31411,
     0.1506, 4.1448, 6.2183, 12.9734, 6.2156, {0.315, 0.908, 0.995}, {0.318, 0.918, 0.995}, shell_order},
    {"shell2", "Shell 2", "2.12", 7904, 3, 28277,
     0.1357, 3.3963, 4.6712, 11.4073, 4.6667, {-0.175, 0.749, 0.993}, {0.085, 0.783, 0.993}, shell_order},
};

const std::vector<UnsignedExample> unsigned_angles{
    {{"annulus"}, "annulus", "3.4", 30, 2.56,
     {{"tangled mesh", -0.223, 1.0, 0.615, 0.279}, {"resulting mesh", 0.039, 1.0, 0.595, 0.325}}},
    {{"naca_le"}, "airfoil", "3.5", 282, 16.63,
     {{"tangled mesh", -0.566, 1.0, 0.968, 0.967}, {"resulting mesh", 0.050, 1.0, 0.970, 0.969}}},
    {{"mech_ch3"}, "mechanical part", "3.6", 182, 2.44,
     {{"tangled mesh", -0.049, 1.0, 0.904, 0.601}, {"resulting mesh", 0.008, 1.0, 0.905, 0.625}}},
    {{"plate1"}, "plate 1", "3.7", 597, 7.40,
     {{"original mesh", 0.287, 1.0, 0.995, 0.412}, {"tangled mesh", -0.716, 1.0, 0.974, 0.375},
      {"resulting mesh", 0.027, 1.0, 0.979, 0.500}}},
    {{"plate2", "plate2_p2"}, "plate 2", "3.8", 597, 7.48,
     {{"original mesh", 0.287, 1.0, 0.995, 0.412}, {"tangled mesh", -0.120, 1.0, 0.966, 0.934},
      {"resulting mesh", 0.042, 1.0, 0.964, 0.930}},
     "inconsistent in the thesis: the caption says third order, but the numbers of the original mesh are those of "
     "figure 3.7, whose mesh is of second order; both orders are measured"},
    {{"beam"}, "beam", "3.9", 542, 6.73,
     {{"original mesh", 1.0, 1.0, 1.0, 1.0}, {"tangled mesh", -0.044, 1.0, 0.982, 0.975},
      {"resulting mesh", 0.032, 1.0, 0.980, 0.973}}},
};

const std::vector<SignedExample> signed_angles{
    {"annulus", "annulus", "4.6", 30, 3, 0.5, 2, 0.005, 0.000, 2, -0.223, 0.472},
    {"mech_ch4", "mechanical part", "4.7", 295, 2, 0.5, 2, 0.041, {}, 2, -0.178, 0.228},
    {"bike_gear", "bike gear", "4.8", 672, 2, 0.035, 5, 0.321, {}, 14, -1.730, 0.211},
    {"pressure_plate", "pressure plate", "4.9", 529, 2, 0.35, 5, 0.249, {}, 6, -0.178, 0.345},
    {"gear", "gear", "4.10", 1340, 3, 0.95, 8, 11.323, 0.005, 8, -0.122, 0.092},
    {"brake_rotor", "brake rotor", "4.11", 7015, 2, 0.85, 2, 19.643, {}, 34, -0.156, 0.346},
    {"bl_airfoil", "airfoil", "4.12", 5328, 3, 0.001, 2, 24.039, 0.005, 2, -0.109, 0.053},
};

const std::vector<AnnulusBeta> betas{
    {0.1, 0.208, 1.0, 0.004},
    {0.5, 0.472, 1.0, 0.005},
    {0.9, 0.348, 1.0, 0.014},
};

const std::vector<ConvergenceStep> steps{
    {0, 0.0000, 29.1931, 29.1931},
    {2, 0.0812, 4.9445, 5.0257},
    {4, 0.3096, 0.1620, 0.4716},
    {9, 0.2538, 0.1963, 0.4501},
};
// clang-format on

}  // namespace

std::span<const FamilyLevel> circle_levels() {
    return circle;
}
std::span<const FamilyLevel> sphere_levels() {
    return sphere;
}
std::span<const WarpExample> warp_examples() {
    return warps;
}
std::span<const UnsignedExample> unsigned_examples() {
    return unsigned_angles;
}
std::span<const SignedExample> signed_examples() {
    return signed_angles;
}
std::span<const AnnulusBeta> annulus_betas() {
    return betas;
}
std::span<const ConvergenceStep> convergence_steps() {
    return steps;
}

}  // namespace curvewright::benchmarks::published
