#pragma once

#include <QSettings>

namespace curvewright {

/// What the window shows when no mesh was asked for.
enum class StartAction { start_page, last_mesh };

/// Which mouse button does what to the camera: habits from other programs. Tools keep the left button.
enum class MouseHabits {
    curvewright,  ///< left and right turn, middle moves
    paraview,     ///< left turns, middle moves, right zooms
    gmsh,         ///< left turns, right moves, middle zooms
    blender,      ///< middle turns, Shift + middle moves, Ctrl + middle zooms
};

/// What the user has chosen once and for all, kept in the settings. Values that are none (a broken or newer file) count
/// as not chosen.
struct Preferences {
    StartAction start = StartAction::start_page;
    int recent_count = 8;           ///< files that are remembered, 0 .. most_recent
    bool keeps_work = true;         ///< unsaved work is kept on disk, for after a crash
    bool remembers_tool = true;     ///< the tool chosen last, for flat meshes and for solids
    bool remembers_drawing = true;  ///< edges, nodes and legend as they were left, else as below
    bool starts_with_edges = true;
    bool starts_with_nodes = false;
    bool starts_with_legend = true;
    bool wheel_is_reversed = false;  ///< the wheel towards the user comes closer
    MouseHabits mouse = MouseHabits::curvewright;
    int worst_count = 10;  ///< elements in the table of the worst, and shown where only they are: 1 .. most_worst
    double soft_radius_percent = 8.0;  ///< of the mesh's diagonal: the radius of the soft selection at first

    static constexpr int most_recent = 30, most_worst = 1000;

    static Preferences load();
    void store() const;
    bool operator==(const Preferences&) const = default;
};

/// A number of the settings as an enumerator; fallback if it is none of 0 .. last.
template <class Enum>
Enum read_enum(const QSettings& settings, const QString& key, Enum last, Enum fallback) {
    bool is_number = false;
    const int value = settings.value(key).toInt(&is_number);
    return is_number && value >= 0 && value <= static_cast<int>(last) ? static_cast<Enum>(value) : fallback;
}

}  // namespace curvewright
