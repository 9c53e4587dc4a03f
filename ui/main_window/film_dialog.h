#pragma once

#include <array>
#include <functional>
#include <memory>

#include <QDialog>
#include <QProcess>

#include "ui/jobs/mesh_jobs.h"
#include "ui/jobs/step_player.h"
#include "ui/main_window/picture_drawing.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;
class QWidget;

namespace curvewright {

class MeshView;
class SizeFields;

/// The line that makes a video of a film's pictures, for a shell.
QString video_command(const QString& folder, const QString& prefix, int per_second, bool is_transparent);
/// The same for a process: the arguments of ffmpeg. video: gets the file that is made.
QStringList video_arguments(const QString& folder, const QString& prefix, int per_second, bool is_transparent,
                            QString& video);

/// File > Export animation: the way of the mesh to its present state, or the steps of the timeline, as pictures for a
/// video or as an animation, drawn from where the view is. The window stays usable beside it.
class FilmDialog : public QDialog {
    Q_OBJECT

  public:
    /// choose_folder: asks for a folder, beginning with one; "" = the user gave up.
    FilmDialog(MeshJobs& jobs, StepPlayer& player, MeshView& view, std::function<QString(const QString&)> choose_folder,
               QWidget* parent);
    /// A running export is stopped.
    ~FilmDialog() override;

    void reject() override;

  signals:
    void failed(const QString& message);

  private:
    void fill_sources();
    bool shows_timeline() const;
    int frame_count() const;
    void change();
    /// Steps are to be seen one by one, a motion is to be smooth: each has a rate of its own.
    void choose_rate();
    void refresh();
    void start();
    QImage draw(const Frame& frame);
    void show_result(const FilmResult& result);
    void show_message(const QString& text, const char* tone);
    void run_ffmpeg();
    bool is_animation() const;
    PictureOptions picture_options() const;
    QString why_not() const;
    void remember() const;

    MeshJobs& jobs_;
    StepPlayer& player_;
    MeshView& view_;
    std::unique_ptr<PictureStudio> studio_;  ///< while a film is written
    PictureOptions drawn_;
    std::shared_ptr<const Recording> filled_recording_;  ///< that can be chosen; null: none
    bool has_caption_ = false, is_writing_ = false, was_writing_ = false;
    QColor caption_color_, caption_ground_;
    QProcess ffmpeg_;
    QString video_;

    QComboBox *from_ = nullptr, *level_ = nullptr, *format_ = nullptr;
    std::array<int, 2> rates_{};  ///< of a motion, of the steps of a timeline
    bool rate_is_of_timeline_ = false;
    QSpinBox *frames_ = nullptr, *per_second_ = nullptr, *quality_ = nullptr;
    QCheckBox *back_ = nullptr, *transparent_ = nullptr, *lossless_ = nullptr, *legend_ = nullptr, *caption_ = nullptr;
    QLabel *duration_ = nullptr, *message_ = nullptr;
    SizeFields* size_ = nullptr;
    QDoubleSpinBox* line_scale_ = nullptr;
    QLineEdit *folder_ = nullptr, *prefix_ = nullptr, *command_ = nullptr;
    QWidget *settings_page_ = nullptr, *result_ = nullptr;
    QPushButton *export_ = nullptr, *video_button_ = nullptr, *close_ = nullptr;
};

}  // namespace curvewright
