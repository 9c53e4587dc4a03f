#pragma once

#include <QSize>
#include <QWidget>

class QCheckBox;
class QComboBox;
class QSpinBox;

namespace curvewright {

/// How large a picture is to be: as the view, a usual size, or any other. Remembers the last choice.
class SizeFields : public QWidget {
    Q_OBJECT

  public:
    /// settings: group of the settings that the choice is kept in. is_even: sizes are even numbers, as videos need
    /// them.
    SizeFields(const QString& settings, bool is_even, QWidget* parent = nullptr);

    /// Of the view, device pixels: what "as the view" means.
    void set_view_size(QSize size);
    QSize picture_size() const;
    void remember() const;

  signals:
    void changed();

  private:
    enum Preset { as_view, twice, full_hd, ultra_hd, own };

    void choose(int preset);
    void follow(QSpinBox* edited, QSpinBox* other);
    void show_size(QSize size);
    QSize size_of(int preset) const;
    int fitting(double pixels) const;

    QString settings_;
    bool is_even_ = false;
    QSize view_size_{1280, 800};
    double proportion_ = 1.6;  ///< width to height, that is kept
    bool is_showing_ = false;
    QComboBox* preset_ = nullptr;
    QSpinBox *width_ = nullptr, *height_ = nullptr;
    QCheckBox* keeps_ = nullptr;
};

}  // namespace curvewright
