# Debian packages, by purpose. Sourced by common.sh.

# To build and run the programs.
run_packages=(g++ cmake ninja-build libvtk9-dev qt6-base-dev libqt6opengl6-dev qt6-svg-dev libeigen3-dev libtbb-dev libmetis-dev
              libfmt-dev libcli11-dev nlohmann-json3-dev libmuparser-dev zlib1g-dev libwebp-dev libegl-dev libgl1-mesa-dri
              qt6-qpa-plugins libqt6svg6 fonts-dejavu-core)
# To make packages.
package_packages=(dpkg-dev file gzip)
# To make the documentation.
docs_packages=(doxygen)
# To fuzz: Clang with its runtime libraries. (The second is named after the first's version in Debian 12.)
fuzz_packages=(clang libclang-rt-14-dev)
# To test: the framework, a display without a screen, and what makes packages.
test_packages=(libgtest-dev xvfb xauth "${package_packages[@]}")
