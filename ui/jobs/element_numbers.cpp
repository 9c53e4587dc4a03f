#include "ui/jobs/element_numbers.h"

#include <exception>

#include <QMetaObject>

#include "core/quality/element_size.h"
#include "core/quality/shape_quality.h"

namespace curvewright {
namespace {

std::shared_ptr<const FieldArray> compute(ElementNumbers::Kind kind, const CurvedMesh* mesh, const CurvedMesh& opened,
                                          const TaskContext& context) {
    if (mesh == nullptr) return nullptr;
    auto field = std::make_shared<FieldArray>();
    field->place = FieldArray::Place::elements;
    try {
        field->values = kind == ElementNumbers::Kind::size ? element_sizes(*mesh, context)
                                                           : element_shapes(*mesh, opened.coordinates(), context);
    } catch (const std::exception&) {
        return nullptr;  // cancelled, or elements that have no such number
    }
    return field;
}

}  // namespace

ElementNumbers::ElementNumbers(QObject* parent) : QObject(parent) {}

ElementNumbers::~ElementNumbers() {
    cancel();
}

void ElementNumbers::request(Kind kind, std::shared_ptr<const CurvedMesh> now, std::shared_ptr<const CurvedMesh> before,
                             std::shared_ptr<const CurvedMesh> opened) {
    cancel();
    is_running_ = true;
    const int request = ++request_;
    thread_ = std::jthread([this, request, kind, now = std::move(now), before = std::move(before),
                            opened = std::move(opened)](const std::stop_token& stop) {
        const TaskContext context{stop, {}};
        const auto of_now = compute(kind, now.get(), *opened, context);
        const auto of_before = before == now ? of_now : compute(kind, before.get(), *opened, context);
        if (stop.stop_requested()) return;
        QMetaObject::invokeMethod(this, [this, request, of_now, of_before] {
            if (request != request_ || !is_running_) return;
            is_running_ = false;
            emit computed(of_now, of_before);
        });
    });
}

void ElementNumbers::cancel() {
    is_running_ = false;
    ++request_;
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

}  // namespace curvewright
