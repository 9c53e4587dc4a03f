#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace curvewright {

/// Looks for a direction n with n·w > 0 for all of a set of vectors that are known to within errors: a proof that no
/// combination of them with non-negative factors vanishes. Iterates like Gilbert's algorithm (Gilbert, Johnson,
/// Keerthi, "A fast procedure for computing the distance between complex objects in three-dimensional space", IEEE J.
/// Robotics Automation 4, 1988) and checks what it finds with rounding bounds. Reusable work space; one object per
/// thread.
class DirectionSearch {
  public:
    void clear();
    /// error: bound of the error of every component of w.
    void add(const Eigen::Vector3d& w, double error);
    void add_negated(const Eigen::Vector3d& w, double error) { add(-w, error); }
    std::size_t size() const { return vectors_.size(); }
    /// Forgets all but the first `size` vectors.
    void shrink(std::size_t size);
    bool exists();

  private:
    std::vector<Eigen::Vector3d> vectors_;  ///< of unit length
    std::vector<double> slack_;             ///< that n·w / |n| has to exceed
};

/// Whether a plane that parts the convex hulls of two point sets is found; error: bound of the error of every
/// coordinate of all points.
bool are_separable(const std::vector<Eigen::Vector3d>& f, const std::vector<Eigen::Vector3d>& g, double error);

/// Up to four points and the point of their hull that is closest to the origin.
class ClosestToOrigin {
  public:
    /// Takes the point in; keeps only those that the closest point is a combination of.
    void add(const Eigen::Vector3d& point);
    const Eigen::Vector3d& closest() const { return closest_; }

  private:
    std::array<Eigen::Vector3d, 4> points_;
    int count_ = 0;
    Eigen::Vector3d closest_ = Eigen::Vector3d::Zero();
};

}  // namespace curvewright
