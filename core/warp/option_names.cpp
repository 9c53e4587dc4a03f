#include "core/warp/neighbours.h"
#include "core/warp/warp.h"

// Apart from what they choose, so that who only reads options needs no solver.

namespace curvewright {

const char* to_string(Weighting weighting) {
    switch (weighting) {
        case Weighting::convex:
            return "convex";
        case Weighting::affine:
            return "affine";
        case Weighting::elastic:
            return "elastic";
        case Weighting::custom:
            return "custom";
    }
    return "";
}

const char* to_string(NeighbourKind kind) {
    switch (kind) {
        case NeighbourKind::all:
            return "all";
        case NeighbourKind::high_order:
            return "high-order";
        case NeighbourKind::edge_connected:
            return "edge";
    }
    return "";
}

}  // namespace curvewright
