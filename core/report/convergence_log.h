#pragma once

#include <optional>
#include <vector>

#include "core/report/thinned.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// How an untangling went, in a few numbers per step. What an observer sees happens in one order only, so the numbers
/// are the same for any number of threads.
namespace convergence {

/// The mesh after a pass.
struct Pass {
    int pass = 0;                 ///< from 1
    int patches = 0;              ///< that were worked on: patches, edges or nodes, as the method has it
    long minimisations = 0;       ///< in these patches
    long iterations = 0;          ///< of the optimiser
    double objective_before = 0;  ///< summed up over the patches, each before its own minimisation
    double objective_after = 0;
    double relative_change = 0;  ///< |X_k - X_{k-1}|_F / |X_k|_F (guaranteed: against the mesh that was given)
    double min_scaled_jacobian = 0;
    Index invalid = 0, undecided = 0;
};
/// A patch after the work on it.
struct Patch {
    int pass = 0, patch = 0;  ///< its number in the pass, from 1
    Index elements = 0, nodes = 0;
    int minimisations = 0, iterations = 0;
    double objective_before = 0, objective_after = 0;
    double min_scaled_jacobian_before = 0, min_scaled_jacobian_after = 0;
};
/// One minimisation of the guaranteed method.
struct Round {
    int pass = 0, patch = 0, round = 0;  ///< round: minimisations of this patch so far, from 1
    int iterations = 0;
    std::optional<double> objective;          ///< at its end; none: it made no step
    std::optional<double> least_determinant;  ///< over the patch's samples, likewise
    // What the certificates say after it; none: the samples were not all positive, so it was not asked.
    std::optional<double> min_scaled_jacobian;
    std::optional<Index> not_valid;
};

}  // namespace convergence

/// Keeps the course of one untangling; of long ones a selection (see Thinned) of passes, patches and rounds.
class ConvergenceLog : public UntangleObserver {
  public:
    void on_event(const UntangleEvent& event) override;

    const Thinned<convergence::Pass>& passes() const { return passes_; }
    const Thinned<convergence::Patch>& patches() const { return patches_; }
    const Thinned<convergence::Round>& rounds() const { return rounds_; }

  private:
    struct Handle;

    void begin_round(int round);
    void end_round();

    convergence::Pass pass_;
    convergence::Patch patch_;
    std::optional<convergence::Round> round_;
    Thinned<convergence::Pass> passes_;
    Thinned<convergence::Patch> patches_;
    Thinned<convergence::Round> rounds_{4096};
};

/// Tells several observers.
class ObserverFan : public UntangleObserver {
  public:
    /// Null is left out. The observers must live as long as the fan.
    void add(UntangleObserver* observer) {
        if (observer != nullptr) observers_.push_back(observer);
    }
    /// Itself, or null if there is nobody to tell.
    UntangleObserver* observer() { return observers_.empty() ? nullptr : this; }
    void on_event(const UntangleEvent& event) override {
        for (UntangleObserver* observer : observers_) observer->on_event(event);
    }

  private:
    std::vector<UntangleObserver*> observers_;
};

}  // namespace curvewright
