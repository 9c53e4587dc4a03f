#pragma once

namespace curvewright {

/// What a drag does to the camera. Flat meshes do not turn: they pan instead.
enum class CameraMotion { turn, pan, zoom };

/// What a drag with one button does, alone and with a key.
struct ButtonMotions {
    CameraMotion alone, with_shift, with_control;
};

/// Which button does what.
struct MouseMap {
    ButtonMotions left{CameraMotion::turn, CameraMotion::pan, CameraMotion::turn};
    ButtonMotions middle{CameraMotion::pan, CameraMotion::pan, CameraMotion::pan};
    ButtonMotions right{CameraMotion::turn, CameraMotion::pan, CameraMotion::turn};
    bool wheel_is_reversed = false;
};

}  // namespace curvewright
