#pragma once

#include <memory>
#include <thread>

#include <QObject>

#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"

namespace curvewright {

/// Computes numbers of all elements on a thread of its own, for the colours of the view. The latest request counts.
class ElementNumbers : public QObject {
    Q_OBJECT

  public:
    enum class Kind {
        size,   ///< length, area or volume
        shape,  ///< worst mean ratio against the straight-sided element of the opened mesh
    };

    explicit ElementNumbers(QObject* parent = nullptr);
    ~ElementNumbers() override;

    /// before may be null. computed() follows, unless another request comes first.
    void request(Kind kind, std::shared_ptr<const CurvedMesh> now, std::shared_ptr<const CurvedMesh> before,
                 std::shared_ptr<const CurvedMesh> opened);
    /// Forgets the request.
    void cancel();
    bool is_running() const { return is_running_; }

  signals:
    /// An array on the elements of each of the two meshes; null where there is none, or where it cannot be computed.
    void computed(std::shared_ptr<const FieldArray> now, std::shared_ptr<const FieldArray> before);

  private:
    std::jthread thread_;
    int request_ = 0;
    bool is_running_ = false;
};

}  // namespace curvewright
