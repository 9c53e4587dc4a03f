#pragma once

#include <optional>
#include <vector>

#include <QWidget>

#include "ui/document/mesh_document.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

class QComboBox;
class QLineEdit;
class QToolButton;

namespace curvewright {

/// What the colours of the view are to show, as the user has chosen.
struct ColorSetting {
    enum class Kind { scaled_jacobian, plain, shape, size, distance_moved, array };
    Kind kind = Kind::scaled_jacobian;
    int array = -1;      ///< position in the document's fields
    int component = -1;  ///< of an array: from 0; -1 = length
    ColorMap map = ColorMap::warm;
    bool is_reversed = false;
    std::optional<double> lower, upper;  ///< ends of the range that the user has given
    QString title, detail;               ///< for the legend
};

/// Small bar over the view: what the colours show, with which map, over which range. Remembers map and range of every
/// quantity, and the quantity.
class ColorBar : public QWidget {
    Q_OBJECT

  public:
    ColorBar(MeshDocument& document, const Theme& theme, QWidget* parent = nullptr);

    const ColorSetting& setting() const { return setting_; }
    /// Of the scaled Jacobian, whatever is shown: for all that has its colours.
    const ColorScale& quality_scale() const { return quality_scale_; }
    /// The range that is shown now: what stands in the fields that the user has left empty.
    void show_range(double lower, double upper);
    /// The numbers are being computed; show_range() ends that.
    void show_waiting();
    /// Offers what the document's mesh has; chooses what was chosen last, or else the scaled Jacobian.
    void refresh();

  signals:
    void changed();
    void close_requested();

  private:
    struct Quantity {
        ColorSetting::Kind kind;
        int array;
        QString key;  ///< in the settings
        QString text, tip;
    };
    std::vector<Quantity> quantities() const;
    const Quantity& chosen() const;
    void choose_quantity(bool by_user);
    void choose_map();
    void read_range();
    void set_component(int component);
    /// Fields and icons as the setting says.
    void show_setting();
    void load(const Quantity& quantity);
    void save() const;
    void find_quality_scale();
    void paint_icons();

    MeshDocument& document_;
    const Theme& theme_;
    std::vector<Quantity> list_;
    ColorSetting setting_;
    ColorScale quality_scale_;
    double shown_lower_ = 0.0, shown_upper_ = 1.0;
    bool is_showing_ = false;
    QComboBox *quantity_ = nullptr, *component_ = nullptr, *map_ = nullptr;
    QToolButton *reverse_ = nullptr, *close_ = nullptr;
    QLineEdit *lower_ = nullptr, *upper_ = nullptr;
    QWidget* scale_row_ = nullptr;
};

}  // namespace curvewright
