#include "core/timeline/replay.h"

#include <type_traits>

#include "core/base/error.h"
#include "core/timeline/cursor.h"

namespace curvewright {

void replay(const std::shared_ptr<const Recording>& recording, UntangleObserver& observer, const TaskContext& context) {
    TimelineCursor cursor(recording);
    for (StepNumber step = 0; step < recording->step_count(); ++step) {
        context.check();
        context.report("reading the steps", double(step) / recording->step_count());
        std::visit(
            [&](auto event) {
                using Event = decltype(event);
                if constexpr (std::is_same_v<Event, WarpIncrement>) {
                    throw Unsupported("A warp in increments has no trace.");
                } else {
                    if constexpr (std::is_same_v<Event, untangle_event::Started>) event.mesh = &recording->mesh();
                    if constexpr (std::is_same_v<Event, untangle_event::PassEnded>) {
                        cursor.seek(step, context);
                        event.coordinates = &cursor.coordinates();
                    }
                    observer.on_event(event);
                }
            },
            recording->read(step));
    }
}

}  // namespace curvewright
