#pragma once

#include <span>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/timeline/bytes.h"
#include "core/timeline/step_event.h"

namespace curvewright {

/// Steps as bytes. Positions of 2D meshes are written without z, which no method changes.
class StepCodec {
  public:
    /// start: the positions at the start; must live as long as the codec.
    StepCodec(int dimension, const Coordinates& start) : columns_(dimension == 3 ? 3 : 2), start_(&start) {}

    /// Nodes that moved, with their positions before and after.
    struct Moved {
        std::vector<Index> nodes;
        std::vector<untangle_event::Position> before, after;
    };

    /// patch: the one that the step is in, or null. moved: for FaceNodesMoved, NodesPlaced and WarpIncrement. pre: the
    /// positions of steps within a patch are those of its first nodes, in their order.
    void encode(const StepEvent& event, const untangle_event::PatchBegan* patch, const Moved* moved,
                ByteWriter& bytes) const;
    StepEvent decode(StepKind kind, std::span<const std::byte> bytes, const untangle_event::PatchBegan* patch) const;
    /// Of a FaceNodesMoved, NodesPlaced or WarpIncrement.
    Moved decode_moved(StepKind kind, std::span<const std::byte> bytes) const;

  private:
    void put_positions(std::span<const untangle_event::Position> positions, ByteWriter& bytes) const;
    /// nodes: whose positions they are.
    std::vector<untangle_event::Position> take_positions(std::span<const Index> nodes, ByteReader& bytes) const;
    void put_moved(const Moved& moved, ByteWriter& bytes) const;
    Moved take_moved(ByteReader& bytes) const;

    std::size_t columns_;
    const Coordinates* start_;
};

}  // namespace curvewright
