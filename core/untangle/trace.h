#pragma once

#include <iosfwd>
#include <memory>

#include "core/untangle/observer.h"

namespace curvewright {

/// Writes every event as one line of JSON: {"event": NAME, …}. Nodes and elements are named by their tags of the file.
/// The first line has the positions at the start, so that the mesh and the trace are all there is to know of a run.
class TraceWriter : public UntangleObserver {
  public:
    /// The stream must live as long as the writer.
    explicit TraceWriter(std::ostream& stream);
    ~TraceWriter() override;
    void on_event(const UntangleEvent& event) override;

  private:
    std::ostream& stream_;
    std::shared_ptr<const MeshTopology> topology_;
};

}  // namespace curvewright
