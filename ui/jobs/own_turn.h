#pragma once

#include <functional>

class QObject;

namespace curvewright {

/// Calls this in a later turn of the event loop that no other such call has part in: what the user does comes between
/// two of them, whoever made them. A zero timer would not do, Qt runs all that are due in one turn. Not if the receiver
/// has been destroyed by then. For the window's thread.
void call_in_own_turn(QObject* receiver, std::function<void()> call);

}  // namespace curvewright
