#pragma once

#include <functional>
#include <memory>

#include <QDialog>
#include <QTimer>

#include "ui/jobs/job_runner.h"
#include "ui/main_window/picture_drawing.h"

class QCheckBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;
class QPushButton;

namespace curvewright {

class MeshView;
class PreviewLabel;
class SizeFields;
class TiledPicture;

/// File > Save picture: what the view shows, at any size, to a file or the clipboard, with a preview. The window stays
/// usable beside it: the preview follows the view. Remembers the last choices.
class PictureDialog : public QDialog {
    Q_OBJECT

  public:
    /// ask_path: for a file name; "" = the user gave up.
    PictureDialog(MeshView& view, std::function<QString()> ask_path, QWidget* parent);
    ~PictureDialog() override;

    PictureOptions options() const;
    /// Whether a picture is being made.
    bool is_busy() const { return drawing_ || runner_.is_running(); }
    /// Whether the small picture in the dialog is about to change.
    bool is_drawing_preview() const { return preview_timer_.isActive() || preview_drawing_; }
    /// Gives up the picture that is being made.
    void stop();

  signals:
    /// A picture was written, or put on the clipboard (path "").
    void saved(const QString& path, QSize size);
    void failed(const QString& message);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void refresh();
    void draw_preview();
    void draw(std::function<void(const QImage&)> then);
    void write(const QString& path, const QImage& image);
    void save();
    void copy();
    void remember() const;

    MeshView& view_;
    std::function<QString()> ask_path_;
    JobRunner runner_;
    QTimer preview_timer_;
    std::unique_ptr<TiledPicture> drawing_;
    std::unique_ptr<TiledPicture> preview_drawing_;  ///< of large meshes
    PreviewLabel* preview_ = nullptr;
    SizeFields* size_ = nullptr;
    QDoubleSpinBox* line_scale_ = nullptr;
    QCheckBox *transparent_ = nullptr, *legend_ = nullptr;
    QLabel* message_ = nullptr;
    QProgressBar* progress_ = nullptr;
    QPushButton *save_ = nullptr, *copy_ = nullptr, *stop_ = nullptr;
};

/// A picture in the middle of its place, on a chequered ground where it is transparent.
class PreviewLabel : public QWidget {
    Q_OBJECT

  public:
    explicit PreviewLabel(QWidget* parent = nullptr);
    /// Its largest size, device pixels.
    QSize room() const;
    void set_picture(const QImage& picture);
    const QImage& picture() const { return picture_; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    QImage picture_;
};

}  // namespace curvewright
