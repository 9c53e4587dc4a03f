#include "core/linear/linear_solver.h"

#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/unit/linear/test_systems.h"

namespace curvewright {
namespace {

using testing::block_matrix;
using testing::BlockMap;
using testing::grid_system;
using testing::random_vectors;

SolverOptions choose(SolverChoice choice, Ordering ordering = Ordering::nested_dissection) {
    SolverOptions options;
    options.choice = choice;
    options.ordering = ordering;
    return options;
}

MultiVector image(const BlockMatrix& matrix, const MultiVector& x) {
    MultiVector b;
    multiply(matrix, x, b);
    return b;
}

TEST(LinearSolver, EveryMethodSolvesManufacturedSystems) {
    for (const double convection : {0.0, 6.0})
        for (int block = 1; block <= 3; ++block) {
            const LinearSystem system = grid_system(23, block, convection);
            MultiVector exact = random_vectors(system.matrix.rows * block, 7, 1);
            exact.col(2).setZero();
            exact.col(6) *= 1e8;
            const MultiVector b = image(system.matrix, exact);
            for (const SolverOptions& options :
                 {choose(SolverChoice::iterative), choose(SolverChoice::direct),
                  choose(SolverChoice::direct, Ordering::minimum_degree), choose(SolverChoice::automatic)}) {
                const LinearSolver solver(system, options);
                SolveReport report;
                const MultiVector x = solver.solve(b, report);
                for (Eigen::Index v = 0; v < 7; ++v)
                    EXPECT_LE((x - exact).col(v).norm(), 1e-9 * exact.col(v).norm())
                        << to_string(options.choice) << " " << convection << " " << block << " " << v;
                EXPECT_TRUE(x.col(2).isZero(0.0));
                EXPECT_LT(report.residual, 1e-11);
                EXPECT_EQ(report.iterations == 0, report.solver == SolverChoice::direct);
                EXPECT_NE(report.solver, SolverChoice::automatic);
            }
        }
}

TEST(LinearSolver, AutomaticIsDirectForSmallSystemsAndIterativeForLargeOnes) {
    SolveReport report;
    const LinearSystem small = grid_system(15), large = grid_system(47);
    LinearSolver(small, {}).solve(MultiVector::Ones(small.matrix.rows, 1), report);
    EXPECT_EQ(report.solver, SolverChoice::direct);
    EXPECT_EQ(report.note, "Direct solver: 225 unknowns are few enough to be factored at once.");
    LinearSolver(large, {}).solve(MultiVector::Ones(large.matrix.rows, 1), report);
    EXPECT_EQ(report.solver, SolverChoice::iterative);
    EXPECT_GT(report.iterations, 0);
    EXPECT_NE(report.note.find("Conjugate gradients with Gauss-Seidel and "), std::string::npos) << report.note;
}

TEST(LinearSolver, ZeroAndNoRightHandSides) {
    for (const SolverChoice choice : {SolverChoice::iterative, SolverChoice::direct}) {
        const LinearSystem system = grid_system(15);
        const LinearSolver solver(system, choose(choice));
        SolveReport report;
        EXPECT_TRUE(solver.solve(MultiVector::Zero(225, 6), report).isZero(0.0));
        EXPECT_EQ(report.residual, 0.0);
        const MultiVector none = solver.solve(MultiVector(225, 0), report);
        EXPECT_EQ(none.rows(), 225);
        EXPECT_EQ(none.cols(), 0);
    }
}

TEST(LinearSolver, DirectTakesOverWhereTheIterationDoesNotConverge) {
    const LinearSystem system = grid_system(31, 1, 6.0);
    SolverOptions options;
    options.max_iterations = 2;
    const MultiVector b = random_vectors(system.matrix.rows, 6, 2);
    SolveReport report;
    const LinearSolver automatic(system, options);
    for (int again = 0; again < 2; ++again) {
        const MultiVector x = automatic.solve(b, report);
        EXPECT_LT((image(system.matrix, x) - b).norm(), 1e-12 * b.norm());
        EXPECT_EQ(report.solver, SolverChoice::direct);
        EXPECT_EQ(report.iterations, 0);
        EXPECT_NE(report.note.find("stopped after 2 iterations at a relative residual of"), std::string::npos);
        EXPECT_NE(report.note.find(" The direct solver took over."), std::string::npos) << report.note;
    }
    options.choice = SolverChoice::iterative;
    const LinearSolver iterative(system, options);
    try {
        iterative.solve(b, report);
        ADD_FAILURE() << "accepted";
    } catch (const SolverFailure& error) {
        EXPECT_NE(std::string(error.what()).find("Try the direct solver."), std::string::npos) << error.what();
    }
    // A usable residual is taken, and the note tells it.
    options.max_iterations = 500;
    options.tolerance = 1e-25;
    const LinearSolver greedy(system, options);
    EXPECT_LT((image(system.matrix, greedy.solve(b, report)) - b).norm(), 1e-10 * b.norm());
    EXPECT_NE(report.note.find(": stopped after "), std::string::npos) << report.note;
}

TEST(LinearSolver, SingularSystemsFail) {
    // Two nodes that are tied to each other and to nothing else, beside one that is held.
    const auto number = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
    for (const bool is_symmetric : {true, false})
        for (const Ordering ordering : {Ordering::nested_dissection, Ordering::minimum_degree})
            for (const SolverChoice choice : {SolverChoice::direct, SolverChoice::iterative, SolverChoice::automatic}) {
                LinearSystem system;
                system.matrix = block_matrix({{{0, 0}, number(1)},
                                              {{0, 1}, number(-1)},
                                              {{1, 0}, number(-1)},
                                              {{1, 1}, number(1)},
                                              {{2, 2}, number(3)}},
                                             3, 3, 1);
                system.is_symmetric = is_symmetric;
                SolveReport report;
                EXPECT_THROW(LinearSolver(system, choose(choice, ordering)).solve(Eigen::Vector3d(1, 2, 3), report),
                             SolverFailure)
                    << is_symmetric << " " << to_string(choice);
            }
}

TEST(LinearSolver, RightHandSideThatIsNotFiniteFails) {
    const LinearSystem system = grid_system(15);
    for (const SolverChoice choice : {SolverChoice::iterative, SolverChoice::direct, SolverChoice::automatic})
        for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
            MultiVector b = MultiVector::Ones(225, 2);
            b(3, 1) = value;
            SolveReport report;
            EXPECT_THROW(LinearSolver(system, choose(choice)).solve(b, report), SolverFailure)
                << to_string(choice) << " " << value;
        }
}

TEST(LinearSolver, SweepOrderWithCoupledPiecesIsRefused) {
    LinearSystem system = grid_system(31);
    system.sweep.stages = {0, system.sweep.stages.back()};
    EXPECT_THROW(LinearSolver(system, choose(SolverChoice::iterative)), SolverFailure);
}

TEST(LinearSolver, CancelsInEveryPhase) {
    const LinearSystem system = grid_system(31, 2, 6.0);
    const MultiVector b = random_vectors(system.matrix.rows * 2, 6, 2);
    SolverOptions falls_back;
    falls_back.max_iterations = 1;
    const auto run = [&](const SolverOptions& options, const TaskContext& context) {
        SolveReport report;
        LinearSolver(system, options, context).solve(b, report, context);
    };
    int stopped = 0;
    for (const SolverOptions& options : {choose(SolverChoice::iterative), choose(SolverChoice::direct), falls_back}) {
        std::vector<std::string> phases;
        run(options, {{}, [&](std::string_view phase, double) {
                          if (phases.empty() || phases.back() != phase) phases.emplace_back(phase);
                      }});
        for (std::size_t target = 0; target < phases.size(); ++target) {
            std::stop_source source;
            std::vector<std::string> seen;
            const ProgressCallback stop = [&](std::string_view phase, double) {
                if (seen.empty() || seen.back() != phase) seen.emplace_back(phase);
                if (seen.size() == target + 1) source.request_stop();
            };
            EXPECT_THROW(run(options, {source.get_token(), stop}), Cancelled) << phases[target];
            EXPECT_EQ(seen.size(), target + 1);
            ++stopped;
        }
        std::stop_source source;
        source.request_stop();
        EXPECT_THROW(run(options, {source.get_token(), {}}), Cancelled);
    }
    EXPECT_GE(stopped, 6);  // preparing, solving; factorising; preparing, solving, factorising
}

TEST(LinearSolver, AFactorisationThatWasAbandonedCanBeAskedForAgain) {
    const LinearSystem system = grid_system(47, 1, 6.0);
    SolverOptions options;
    options.max_iterations = 1;
    const LinearSolver solver(system, options);
    const MultiVector b = random_vectors(system.matrix.rows, 1, 2);
    SolveReport report;
    std::stop_source source;
    const ProgressCallback stop = [&](std::string_view phase, double) {
        if (phase == "Factorising") source.request_stop();
    };
    EXPECT_THROW(solver.solve(b, report, {source.get_token(), stop}), Cancelled);
    const MultiVector x = solver.solve(b, report);
    EXPECT_LT((image(system.matrix, x) - b).norm(), 1e-12 * b.norm());
}

TEST(LinearSolver, SolvesFromSeveralThreadsAtOnce) {
    const LinearSystem system = grid_system(63, 1, 6.0);
    SolverOptions falls_back;
    falls_back.max_iterations = 1;
    for (const SolverOptions& options : {choose(SolverChoice::iterative), choose(SolverChoice::direct), falls_back}) {
        const LinearSolver solver(system, options), reference(system, options);
        std::array<MultiVector, 3> b, x;
        std::array<SolveReport, 3> reports;
        for (unsigned i = 0; i < 3; ++i) b[i] = random_vectors(system.matrix.rows, 2, i);
        {
            std::vector<std::jthread> threads;
            for (std::size_t i = 0; i < 3; ++i) threads.emplace_back([&, i] { x[i] = solver.solve(b[i], reports[i]); });
        }
        for (std::size_t i = 0; i < 3; ++i) {
            SolveReport report;
            EXPECT_EQ(x[i], reference.solve(b[i], report));
            EXPECT_EQ(reports[i].iterations, report.iterations);
            EXPECT_EQ(reports[i].note, report.note);
        }
    }
}

TEST(LinearSolver, SameBitsForEveryThreadCount) {
    for (const double convection : {0.0, 6.0})
        for (const SolverChoice choice : {SolverChoice::iterative, SolverChoice::direct}) {
            const LinearSystem system = grid_system(95, 1, convection);
            const MultiVector b = random_vectors(system.matrix.rows, 5, 1);
            std::vector<MultiVector> results;
            for (const int threads : {1, 2, 4}) {
                set_thread_count(threads);
                SolveReport report;
                results.push_back(LinearSolver(system, choose(choice)).solve(b, report));
            }
            set_thread_count(0);
            EXPECT_EQ(results[0], results[1]);
            EXPECT_EQ(results[0], results[2]);
        }
}

TEST(LinearSolver, KeepsItsMatrix) {
    const LinearSystem system = grid_system(15, 2);
    const LinearSolver solver(system, {});
    EXPECT_EQ(solver.matrix().values, system.matrix.values);
    EXPECT_EQ(solver.matrix().column_of, system.matrix.column_of);
}

}  // namespace
}  // namespace curvewright
