#include "core/timeline/step_codec.h"

namespace curvewright {
namespace {

namespace event = untangle_event;
using event::Position;

template <class Value>
void put_vector(const std::vector<Value>& values, ByteWriter& bytes) {
    bytes.put(static_cast<std::uint32_t>(values.size()));
    bytes.put_all(std::span<const Value>(values));
}
template <class Value>
std::vector<Value> take_vector(ByteReader& bytes) {
    std::vector<Value> values(bytes.take<std::uint32_t>());
    bytes.take_all(std::span<Value>(values));
    return values;
}

/// The scalars of a BfgsStep, an EnergyStep, a PatchEnded and a PassEnded, which hold vectors or pointers besides.
struct BfgsNumbers {
    int iteration;
    std::uint32_t count;
    double objective, gradient_norm, step;
    std::array<double, 4> angles;
};
struct EnergyNumbers {
    int round, iteration;
    double objective, eps, sharpness, least_determinant;
};
struct EndNumbers {
    int iterations;
    double beta, objective_before, objective_after, before, after;
};
struct PassNumbers {
    int pass;
    Index invalid, undecided;
    double relative_change, min_scaled_jacobian;
};

std::span<const Index> first_nodes(const event::PatchBegan& patch, std::size_t count) {
    return std::span(patch.nodes).first(count);
}

}  // namespace

void StepCodec::put_positions(std::span<const Position> positions, ByteWriter& bytes) const {
    for (const Position& position : positions) bytes.put_all(std::span(position).first(columns_));
}

std::vector<Position> StepCodec::take_positions(std::span<const Index> nodes, ByteReader& bytes) const {
    std::vector<Position> positions(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        positions[i][2] = (*start_)(nodes[i], 2);
        bytes.take_all(std::span(positions[i]).first(columns_));
    }
    return positions;
}

void StepCodec::put_moved(const Moved& moved, ByteWriter& bytes) const {
    put_vector(moved.nodes, bytes);
    put_positions(moved.before, bytes);
    put_positions(moved.after, bytes);
}

StepCodec::Moved StepCodec::take_moved(ByteReader& bytes) const {
    Moved moved;
    moved.nodes = take_vector<Index>(bytes);
    moved.before = take_positions(moved.nodes, bytes);
    moved.after = take_positions(moved.nodes, bytes);
    return moved;
}

void StepCodec::encode(const StepEvent& event, const event::PatchBegan* patch, const Moved* moved,
                       ByteWriter& bytes) const {
    struct Encode {
        const StepCodec& codec;
        const event::PatchBegan* patch;
        const Moved* moved;
        ByteWriter& bytes;

        void operator()(const event::Started&) const {}
        void operator()(const event::PassBegan& e) const { bytes.put(e); }
        void operator()(const event::PatchBegan& e) const {
            put_vector(e.nodes, bytes);
            put_vector(e.elements, bytes);
            codec.put_positions(e.positions, bytes);
        }
        void operator()(const event::SimplexStep& e) const { bytes.put(e); }
        void operator()(const event::BfgsStep& e) const {
            bytes.put(BfgsNumbers{e.iteration, static_cast<std::uint32_t>(e.positions.size()), e.objective,
                                  e.gradient_norm, e.step, e.angles});
            codec.put_positions(e.positions, bytes);
        }
        void operator()(const event::EnergyStep& e) const {
            bytes.put(EnergyNumbers{e.round, e.iteration, e.objective, e.eps, e.sharpness, e.least_determinant});
            for (std::size_t i = 0; i < e.positions.size(); ++i)
                for (std::size_t d = 0; d < codec.columns_; ++d)
                    bytes.put(static_cast<float>(e.positions[i][d] - patch->positions[i][d]));
        }
        void operator()(const event::PatchCertified& e) const { bytes.put(e); }
        void operator()(const event::PatchEnded& e) const {
            bytes.put(EndNumbers{e.iterations, e.beta, e.objective_before, e.objective_after,
                                 e.min_scaled_jacobian_before, e.min_scaled_jacobian_after});
            codec.put_positions(e.positions, bytes);
        }
        void operator()(const event::FaceNodesMoved&) const { codec.put_moved(*moved, bytes); }
        void operator()(const event::NodesPlaced& e) const {
            bytes.put(e.placement);
            codec.put_moved(*moved, bytes);
        }
        void operator()(const event::PassEnded& e) const {
            bytes.put(PassNumbers{e.pass, e.invalid, e.undecided, e.relative_change, e.min_scaled_jacobian});
        }
        void operator()(const event::Finished& e) const { bytes.put(e); }
        void operator()(const WarpIncrement& e) const {
            bytes.put(e);
            codec.put_moved(*moved, bytes);
        }
    };
    std::visit(Encode{*this, patch, moved, bytes}, event);
}

StepEvent StepCodec::decode(StepKind kind, std::span<const std::byte> record, const event::PatchBegan* patch) const {
    ByteReader bytes(record);
    switch (kind) {
        case StepKind::started:
            return event::Started{};
        case StepKind::pass_began:
            return bytes.take<event::PassBegan>();
        case StepKind::patch_began: {
            event::PatchBegan e;
            e.nodes = take_vector<Index>(bytes);
            e.elements = take_vector<Index>(bytes);
            e.positions = take_positions(e.nodes, bytes);
            return e;
        }
        case StepKind::simplex_step:
            return bytes.take<event::SimplexStep>();
        case StepKind::bfgs_step: {
            const auto numbers = bytes.take<BfgsNumbers>();
            event::BfgsStep e{numbers.iteration,     {},           numbers.objective,
                              numbers.gradient_norm, numbers.step, numbers.angles};
            e.positions = take_positions(first_nodes(*patch, numbers.count), bytes);
            return e;
        }
        case StepKind::energy_step: {
            const auto numbers = bytes.take<EnergyNumbers>();
            event::EnergyStep e{numbers.round,     numbers.iteration,         numbers.objective, numbers.eps,
                                numbers.sharpness, numbers.least_determinant, patch->positions};
            for (Position& position : e.positions)
                for (std::size_t d = 0; d < columns_; ++d) position[d] += bytes.take<float>();
            return e;
        }
        case StepKind::patch_certified:
            return bytes.take<event::PatchCertified>();
        case StepKind::patch_ended: {
            const auto numbers = bytes.take<EndNumbers>();
            event::PatchEnded e;
            e.nodes = patch->nodes;
            e.iterations = numbers.iterations;
            e.beta = numbers.beta;
            e.objective_before = numbers.objective_before;
            e.objective_after = numbers.objective_after;
            e.min_scaled_jacobian_before = numbers.before;
            e.min_scaled_jacobian_after = numbers.after;
            e.positions = take_positions(e.nodes, bytes);
            return e;
        }
        case StepKind::face_nodes_moved: {
            Moved moved = take_moved(bytes);
            return event::FaceNodesMoved{std::move(moved.nodes), std::move(moved.after)};
        }
        case StepKind::nodes_placed: {
            const auto placement = bytes.take<event::Placement>();
            Moved moved = take_moved(bytes);
            return event::NodesPlaced{placement, std::move(moved.nodes), std::move(moved.after)};
        }
        case StepKind::pass_ended: {
            const auto numbers = bytes.take<PassNumbers>();
            return event::PassEnded{numbers.pass,    numbers.relative_change, numbers.min_scaled_jacobian,
                                    numbers.invalid, numbers.undecided,       nullptr};
        }
        case StepKind::finished:
            return bytes.take<event::Finished>();
        case StepKind::increment:
            return bytes.take<WarpIncrement>();
    }
    return event::Started{};
}

StepCodec::Moved StepCodec::decode_moved(StepKind kind, std::span<const std::byte> record) const {
    ByteReader bytes(record);
    if (kind == StepKind::nodes_placed) bytes.take<event::Placement>();
    if (kind == StepKind::increment) bytes.take<WarpIncrement>();
    return take_moved(bytes);
}

}  // namespace curvewright
