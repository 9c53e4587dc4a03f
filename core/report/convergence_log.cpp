#include "core/report/convergence_log.h"

namespace curvewright {

namespace event = untangle_event;

struct ConvergenceLog::Handle {
    ConvergenceLog& log;

    void operator()(const event::Started&) const { log = ConvergenceLog(); }
    void operator()(const event::PassBegan& e) const {
        log.pass_ = {};
        log.pass_.pass = e.pass;
    }
    void operator()(const event::PatchBegan& e) const {
        log.patch_ = {};
        log.patch_.pass = log.pass_.pass;
        log.patch_.patch = ++log.pass_.patches;
        log.patch_.elements = static_cast<Index>(e.elements.size());
        log.patch_.nodes = static_cast<Index>(e.nodes.size());
    }
    void operator()(const event::EnergyStep& e) const {
        log.begin_round(e.round);
        log.round_->iterations = e.iteration;
        log.round_->objective = e.objective;
        log.round_->least_determinant = e.least_determinant;
    }
    void operator()(const event::PatchCertified& e) const {
        log.begin_round(e.round);
        log.round_->min_scaled_jacobian = e.min_scaled_jacobian;
        log.round_->not_valid = e.not_valid;
    }
    void operator()(const event::PatchEnded& e) const {
        log.end_round();
        convergence::Patch& patch = log.patch_;
        if (patch.minimisations == 0) patch.minimisations = 1;  // of methods that have no rounds
        patch.iterations = e.iterations;
        patch.objective_before = e.objective_before;
        patch.objective_after = e.objective_after;
        patch.min_scaled_jacobian_before = e.min_scaled_jacobian_before;
        patch.min_scaled_jacobian_after = e.min_scaled_jacobian_after;
        log.pass_.minimisations += patch.minimisations;
        log.pass_.iterations += e.iterations;
        log.pass_.objective_before += e.objective_before;
        log.pass_.objective_after += e.objective_after;
        log.patches_.add(patch);
    }
    void operator()(const event::PassEnded& e) const {
        log.pass_.relative_change = e.relative_change;
        log.pass_.min_scaled_jacobian = e.min_scaled_jacobian;
        log.pass_.invalid = e.invalid;
        log.pass_.undecided = e.undecided;
        log.passes_.add(log.pass_);
    }
    void operator()(const event::Finished&) const { log.end_round(); }
    void operator()(const auto&) const {}  // the others are too many, or say nothing of the course
};

void ConvergenceLog::on_event(const UntangleEvent& event) {
    std::visit(Handle{*this}, event);
}

void ConvergenceLog::begin_round(int round) {
    if (round_ && round_->round == round) return;
    end_round();
    round_ = convergence::Round{};
    round_->pass = pass_.pass;
    round_->patch = patch_.patch;
    round_->round = round;
    patch_.minimisations = round;
}

void ConvergenceLog::end_round() {
    if (round_) rounds_.add(*round_);
    round_.reset();
}

}  // namespace curvewright
