// The certified scaled Jacobian, element by element, against numbers from an independent implementation: Python, J
// sampled at the lattice of its own degree and converted to Bézier form, regular subdivision into 4 or 8,
// tolerance 2.5e-4.

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/quality/quality.h"

namespace curvewright {
namespace {

const std::string data = CURVEWRIGHT_TEST_DATA "/oracle/";
const std::string samples = CURVEWRIGHT_SAMPLES "/";

struct Expected {
    double scaled_jacobian = 0.0;  ///< NaN: inverted everywhere, where the two define the ratio differently
    bool is_invalid = false;
};

std::map<std::int64_t, Expected> read_expected(const std::string& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    std::map<std::int64_t, Expected> expected;
    while (std::getline(stream, line)) {
        std::istringstream fields(line);
        std::string tag, value, invalid;
        std::getline(fields, tag, ',');
        std::getline(fields, value, ',');
        std::getline(fields, invalid, ',');
        expected[std::stoll(tag)] = {value == "inverted" ? std::nan("") : std::stod(value), invalid == "1"};
    }
    return expected;
}

void compare(const CurvedMesh& mesh, const std::string& name) {
    const auto expected = read_expected(data + name + ".csv");
    const QualityReport report = assess_quality(mesh);
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(mesh.topology().element_count()));
    int invalid = 0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const auto tag = mesh.topology().element_tag(element).value;
        ASSERT_TRUE(expected.contains(tag));
        const Expected& e = expected.at(tag);
        const ElementQuality& q = report.elements[element];
        EXPECT_EQ(q.validity, e.is_invalid ? Validity::invalid : Validity::valid) << name << ", element " << tag;
        if (!std::isnan(e.scaled_jacobian)) {
            // Both are within their tolerance, relative to max |J|; a ratio far below 0 carries it along.
            EXPECT_NEAR(q.scaled_jacobian, e.scaled_jacobian, 1e-3 * std::max(1.0, std::abs(e.scaled_jacobian)))
                << name << ", element " << tag;
        }
        invalid += e.is_invalid ? 1 : 0;
    }
    EXPECT_GT(invalid, 0) << "a case without tangled elements proves little";
    EXPECT_EQ(report.summary.invalid, invalid);
}

CurvedMesh deformed_sample(const std::string& name, const std::string& mesh_file) {
    const CurvedMesh mesh = read_mesh(samples + name + "/" + mesh_file).mesh;
    return mesh.with_coordinates(apply_deformation(mesh, read_deformation(samples + name + "/deformation.json")));
}

TEST(Oracle, AnnulusP3) {
    compare(deformed_sample("annulus", "annulus.msh"), "annulus");
}
TEST(Oracle, NacaLeadingEdgeP3) {
    compare(read_mesh(data + "naca_le.msh").mesh, "naca_le");
}
TEST(Oracle, MechanicalPartP2) {
    compare(read_mesh(data + "mech_ch3.msh").mesh, "mech_ch3");
}
TEST(Oracle, SecondMechanicalPartP2) {
    compare(read_mesh(data + "mech_ch4.msh").mesh, "mech_ch4");
}
TEST(Oracle, MovingSphereP3Tetrahedra) {
    compare(deformed_sample("moving_sphere_small", "moving_sphere_small.msh.gz"), "moving_sphere_small");
}

}  // namespace
}  // namespace curvewright
