#include "ui/main_window/film_dialog.h"

#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QPointer>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QStandardPaths>
#include <QUndoStack>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/size_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

/// For a POSIX shell.
QString quoted(const QString& word) {
    QString text = word;
    return QLatin1Char('\'') + text.replace(QLatin1Char('\''), QStringLiteral("'\\''")) + QLatin1Char('\'');
}

QSpinBox* make_count(const char* object_name, int lower, int upper, int value) {
    auto* box = new QSpinBox;
    box->setObjectName(QLatin1String(object_name));
    box->setLocale(QLocale::c());
    box->setRange(lower, upper);
    box->setValue(value);
    return box;
}

QCheckBox* make_check(const char* object_name, const QString& text, const QString& tip, bool is_on) {
    auto* box = new QCheckBox(text);
    box->setObjectName(QLatin1String(object_name));
    box->setToolTip(tip);
    box->setChecked(is_on);
    return box;
}

/// What stands for the timeline among the states of the history that a film can begin with.
constexpr int of_timeline = -1;

/// "gear" of gear.msh and of gear.msh.gz.
QString stem_of(QString file_name) {
    if (file_name.endsWith(QLatin1String(".gz"))) file_name.chop(3);
    return QFileInfo(file_name).completeBaseName();
}

QString setting(const char* name) {
    return QStringLiteral("film/") + QLatin1String(name);
}

}  // namespace

QStringList video_arguments(const QString& folder, const QString& prefix, int per_second, bool is_transparent,
                            QString& video) {
    // Of what looks like a number's place, only the last one is.
    QString stem = QDir(folder).filePath(prefix);
    video = stem + (is_transparent ? QStringLiteral(".webm") : QStringLiteral(".mp4"));
    const QString pattern = stem.replace(QLatin1Char('%'), QStringLiteral("%%")) + QStringLiteral("-%04d.png");
    QStringList arguments{QStringLiteral("-framerate"), QString::number(per_second), QStringLiteral("-i"), pattern};
    if (is_transparent)
        arguments << QStringLiteral("-c:v") << QStringLiteral("libvpx-vp9") << QStringLiteral("-pix_fmt")
                  << QStringLiteral("yuva420p");
    else
        arguments << QStringLiteral("-c:v") << QStringLiteral("libx264") << QStringLiteral("-pix_fmt")
                  << QStringLiteral("yuv420p");
    return arguments << video;
}

QString video_command(const QString& folder, const QString& prefix, int per_second, bool is_transparent) {
    QString video, line = QStringLiteral("ffmpeg");
    for (const QString& argument : video_arguments(folder, prefix, per_second, is_transparent, video))
        line += QLatin1Char(' ') + (argument.contains(QLatin1Char('/')) ? quoted(argument) : argument);
    return line;
}

FilmDialog::FilmDialog(MeshJobs& jobs, StepPlayer& player, MeshView& view,
                       std::function<QString(const QString&)> choose_folder, QWidget* parent)
    : QDialog(parent), jobs_(jobs), player_(player), view_(view) {
    setObjectName(QStringLiteral("film_dialog"));
    setWindowTitle(tr("Export an animation"));
    setAttribute(Qt::WA_DeleteOnClose);
    MeshDocument& document = jobs.document();
    const QSettings settings;
    const auto saved = [&settings](const char* name, const QVariant& otherwise) {
        return settings.value(setting(name), otherwise);
    };

    from_ = new QComboBox;
    from_->setObjectName(QStringLiteral("film_from"));
    from_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    from_->setMinimumContentsLength(24);
    level_ = make_choice("film_level", tr("How far it is from one picture to the next."),
                         {{tr("by pass"), static_cast<int>(StepLevel::pass), tr("the mesh after every pass.")},
                          {tr("by patch"), static_cast<int>(StepLevel::patch), tr("the mesh after every patch.")},
                          {tr("by iteration"), static_cast<int>(StepLevel::iteration),
                           tr("every step of every patch, with the patch in focus outlined.")}});
    level_->setCurrentIndex(level_->findData(saved("level", static_cast<int>(player.level())).toInt()));
    frames_ = make_count("film_frames", 2, 2000, saved("frames", 60).toInt());
    rates_ = {saved("per_second", 30).toInt(), saved("steps_per_second", 8).toInt()};
    per_second_ = make_count("film_per_second", 1, 120, rates_[0]);
    per_second_->setSuffix(tr(" per second"));
    duration_ = make_label(QString(), "muted");
    duration_->setObjectName(QStringLiteral("film_duration"));
    back_ = make_check("film_back", tr("There and back"), tr("And the same way back, so that it can run in a loop"),
                       saved("back", false).toBool());
    size_ = new SizeFields(QStringLiteral("film"), true);
    size_->set_view_size(view.device_size());
    line_scale_ = make_number("film_lines", 0.25, 8.0, 0.25, 2, saved("line_scale", 1.0).toDouble());
    line_scale_->setPrefix(QStringLiteral("× "));
    line_scale_->setToolTip(tr("Thickness of lines and size of text and points. At × 1 they grow with the picture."));
    transparent_ = make_check("film_transparent", tr("Transparent ground"), tr("What is not the mesh is see-through"),
                              saved("transparent", false).toBool());
    legend_ = make_check("film_legend", tr("Legend"), QString(), saved("legend", true).toBool());
    legend_->setEnabled(view.options().show_legend);
    caption_ = make_check("film_caption", tr("Caption"), tr("What happens, at the lower left of every picture"),
                          saved("caption", true).toBool());
    format_ = make_choice(
        "film_format", tr("What is written."),
        {{tr("PNG pictures, for a video"), 0,
          tr("one file per picture; ffmpeg makes a video of them, as programs for slides want it.")},
         {tr("Animated WebP, one file"), 1,
          tr("every browser plays it in a loop, like any other picture of a page; see-through if the ground is.")}});
    format_->setCurrentIndex(format_->findData(saved("animated", false).toBool() ? 1 : 0));
    quality_ = make_count("film_quality", 1, 100, saved("quality", 90).toInt());
    quality_->setPrefix(tr("quality "));
    quality_->setToolTip(tr("From 1, small, to 100, fine"));
    lossless_ = make_check("film_lossless", tr("Lossless"), tr("Every pixel as it was drawn, in a larger file"),
                           saved("lossless", false).toBool());
    const QString beside = settings.value(QStringLiteral("last_folder"), QDir::homePath()).toString() +
                           tr("/%1-animation").arg(stem_of(document.file_name()));
    folder_ = new QLineEdit(saved("folder", beside).toString());
    folder_->setObjectName(QStringLiteral("film_folder"));
    auto* browse = new QPushButton(tr("Choose…"));
    browse->setObjectName(QStringLiteral("film_browse"));
    prefix_ = new QLineEdit(stem_of(document.file_name()));
    prefix_->setObjectName(QStringLiteral("film_prefix"));
    prefix_->setToolTip(tr("The pictures are called NAME-0001.png and so on, an animation NAME.webp"));
    message_ = make_paragraph(QString(), "");
    message_->setObjectName(QStringLiteral("film_message"));

    auto* form = make_form();
    form->setContentsMargins(0, 0, 0, 0);
    const auto add_pair = [form](const QString& label, QWidget* first, QWidget* second) {
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(first, 1);
        row->addWidget(second);
        form->addRow(label, row);
    };
    add_pair(tr("From"), from_, level_);
    auto* kind = new QHBoxLayout;
    kind->setSpacing(8);
    kind->addWidget(format_, 1);
    kind->addWidget(quality_);
    kind->addWidget(lossless_);
    form->addRow(tr("Format"), kind);
    add_pair(tr("Pictures"), frames_, per_second_);
    add_pair(QString(), back_, duration_);
    form->addRow(tr("Size"), size_);
    if (auto* label = qobject_cast<QLabel*>(form->labelForField(size_)))
        label->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    form->addRow(tr("Lines and text"), line_scale_);
    auto* checks = new QHBoxLayout;
    checks->setSpacing(16);
    for (QCheckBox* box : {transparent_, legend_, caption_}) checks->addWidget(box);
    checks->addStretch(1);
    form->addRow(QString(), checks);
    add_pair(tr("Folder"), folder_, browse);
    form->addRow(tr("Name"), prefix_);
    settings_page_ = new QWidget;
    settings_page_->setLayout(form);

    result_ = new QWidget;
    command_ = new QLineEdit;
    command_->setObjectName(QStringLiteral("film_command"));
    command_->setReadOnly(true);
    auto* copy = new QPushButton(tr("Copy"));
    copy->setObjectName(QStringLiteral("film_copy"));
    video_button_ = new QPushButton;
    video_button_->setObjectName(QStringLiteral("film_video"));
    auto* command_row = new QHBoxLayout;
    command_row->setSpacing(8);
    command_row->addWidget(command_, 1);
    command_row->addWidget(copy);
    command_row->addWidget(video_button_);
    auto* result_layout = new QVBoxLayout(result_);
    result_layout->setContentsMargins(0, 0, 0, 0);
    result_layout->setSpacing(4);
    result_layout->addWidget(make_label(tr("A video of them, with ffmpeg:"), "section"));
    result_layout->addLayout(command_row);
    result_->hide();

    export_ = make_primary_button(tr("Export"), QStringLiteral("film_export"));
    export_->setDefault(true);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    close_ = buttons->button(QDialogButtonBox::Close);
    close_->setObjectName(QStringLiteral("film_close"));
    buttons->addButton(export_, QDialogButtonBox::AcceptRole);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 12);
    layout->setSpacing(12);
    layout->addWidget(settings_page_);
    layout->addWidget(message_);
    layout->addWidget(result_);
    layout->addStretch(1);
    layout->addWidget(buttons);
    setMinimumWidth(520);

    for (QComboBox* box : {from_, level_, format_})
        connect(box, &QComboBox::currentIndexChanged, this, &FilmDialog::change);
    connect(lossless_, &QCheckBox::toggled, this, &FilmDialog::change);
    for (QSpinBox* box : {frames_, per_second_}) connect(box, &QSpinBox::valueChanged, this, &FilmDialog::change);
    for (QCheckBox* box : {back_, transparent_}) connect(box, &QCheckBox::toggled, this, &FilmDialog::change);
    for (QLineEdit* line : {folder_, prefix_}) connect(line, &QLineEdit::textChanged, this, &FilmDialog::change);
    connect(size_, &SizeFields::changed, this, &FilmDialog::change);
    connect(browse, &QPushButton::clicked, this, [this, choose_folder = std::move(choose_folder)] {
        const QString folder = choose_folder(folder_->text());
        if (!folder.isEmpty()) folder_->setText(folder);
    });
    connect(export_, &QPushButton::clicked, this, &FilmDialog::start);
    connect(buttons, &QDialogButtonBox::rejected, this, &FilmDialog::reject);
    connect(copy, &QPushButton::clicked, this, [this] { QGuiApplication::clipboard()->setText(command_->text()); });
    connect(video_button_, &QPushButton::clicked, this, &FilmDialog::run_ffmpeg);
    connect(&jobs.runner(), &JobRunner::progress, this, [this](const QString& phase, double) {
        if (is_writing_ && !phase.isEmpty()) show_message(tr("Writing %1…").arg(phase), "muted");
    });
    connect(&jobs.runner(), &JobRunner::running_changed, this, [this](bool is_running) {
        was_writing_ = !is_running && is_writing_;
        if (was_writing_) {
            is_writing_ = false;
            studio_.reset();
            fill_sources();
        }
        refresh();
    });
    connect(&jobs.runner(), &JobRunner::failed, this, [this] {
        if (was_writing_) show_message({}, "");
    });
    connect(&jobs.runner(), &JobRunner::cancelled, this, [this] {
        if (!was_writing_) return;
        show_message(is_animation() ? tr("Stopped; nothing was written.")
                                    : tr("Stopped; the pictures so far are in the folder."),
                     "warning");
    });
    connect(&document, &MeshDocument::opened, this, &QDialog::reject);
    connect(&document, &MeshDocument::state_changed, this, [this] {
        // The present state is the end of the film.
        QDialog::reject();
    });
    connect(&player, &StepPlayer::opened_changed, this, [this] {
        if (!is_writing_) fill_sources();
    });
    connect(&ffmpeg_, &QProcess::finished, this, [this](int status, QProcess::ExitStatus how) {
        refresh();
        if (how == QProcess::NormalExit && status == 0) {
            show_message(tr("%1 is there.").arg(QDir::toNativeSeparators(video_)), "good");
            return;
        }
        const QStringList said = QString::fromLocal8Bit(ffmpeg_.readAll()).split(QLatin1Char('\n'), Qt::SkipEmptyParts);
        show_message(tr("ffmpeg did not make the video: %1").arg(said.isEmpty() ? tr("no reason given") : said.back()),
                     "warning");
    });
    connect(&ffmpeg_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
        if (error != QProcess::FailedToStart) return;
        refresh();
        show_message(tr("ffmpeg could not be started: %1.").arg(ffmpeg_.errorString()), "warning");
    });
    fill_sources();
    change();
}

/// Where the film can begin: with the timeline if one is open.
void FilmDialog::fill_sources() {
    if (player_.recording() == filled_recording_ && from_->count() > 0) return;
    filled_recording_ = player_.recording();
    const QSignalBlocker blocker(from_);
    from_->clear();
    if (filled_recording_) from_->addItem(tr("The steps of the timeline"), of_timeline);
    const QUndoStack& history = *jobs_.document().history();
    const int index = history.index();
    if (index > 0) from_->addItem(tr("The mesh as opened"), 0);
    if (index > 1) from_->addItem(tr("Before the last step (%1)").arg(history.text(index - 1)), index - 1);
    if (from_->count() == 0)
        QDialog::reject();
    else
        change();
}

bool FilmDialog::shows_timeline() const {
    return from_->currentData() == of_timeline;
}

int FilmDialog::frame_count() const {
    if (!shows_timeline() || !filled_recording_) return frames_->value();
    return std::min(frames_->value(), count_steps(*filled_recording_, chosen<StepLevel>(level_)));
}

FilmDialog::~FilmDialog() {
    if (is_writing_) jobs_.runner().cancel();
    ffmpeg_.disconnect(this);
    ffmpeg_.kill();
    ffmpeg_.waitForFinished(2000);
}

void FilmDialog::reject() {
    // The first press stops what runs, the next one closes.
    if (is_writing_) {
        jobs_.runner().cancel();
        return;
    }
    if (ffmpeg_.state() != QProcess::NotRunning) {
        ffmpeg_.kill();
        return;
    }
    QDialog::reject();
}

bool FilmDialog::is_animation() const {
    return format_->currentData().toInt() == 1;
}

PictureOptions FilmDialog::picture_options() const {
    PictureOptions options;
    options.size = size_->picture_size();
    options.line_scale = line_scale_->value();
    options.is_transparent = transparent_->isChecked();
    options.has_legend = legend_->isChecked();
    return options;
}

QString FilmDialog::why_not() const {
    if (folder_->text().trimmed().isEmpty()) return tr("Choose a folder for the pictures.");
    if (prefix_->text().isEmpty() || prefix_->text().contains(QLatin1Char('/')))
        return tr("Give the pictures a name without “/”.");
    if (is_animation() && per_second_->value() > AnimationFile::max_rate)
        return tr("Browsers show at most %1 pictures per second of an animation.").arg(AnimationFile::max_rate);
    const QSize size = size_->picture_size();
    if (is_animation() && std::max(size.width(), size.height()) > AnimationFile::max_side)
        return tr("An animation has at most %1 pixels on a side.").arg(format_count(AnimationFile::max_side));
    return why_no_picture(size_->picture_size(), view_.largest_picture_side());
}

void FilmDialog::refresh() {
    const bool makes_video = ffmpeg_.state() != QProcess::NotRunning;
    const int count = pictures_of(frame_count(), back_->isChecked());
    duration_->setText(tr("%1 pictures, %2 s")
                           .arg(format_count(count), QString::number(double(count) / per_second_->value(), 'f', 1)));
    level_->setVisible(shows_timeline());
    frames_->setPrefix(shows_timeline() ? tr("at most ") : QString());
    frames_->setToolTip(shows_timeline()
                            ? tr("If there are more steps, so many of them in even distances, the first and the last "
                                 "among them")
                            : tr("Pictures from the first state to the last"));
    for (QWidget* field : {static_cast<QWidget*>(quality_), static_cast<QWidget*>(lossless_)})
        field->setVisible(is_animation());
    quality_->setEnabled(!lossless_->isChecked());
    const QString problem = why_not();
    export_->setEnabled(problem.isEmpty() && !jobs_.runner().is_running() && !makes_video);
    settings_page_->setEnabled(!is_writing_ && !makes_video);
    close_->setText(is_writing_ || makes_video ? tr("Stop") : tr("Close"));
    video_button_->setText(makes_video ? tr("Making it…") : tr("Make it"));
    video_button_->setEnabled(!makes_video);
}

void FilmDialog::choose_rate() {
    if (rate_is_of_timeline_ == shows_timeline()) return;
    rates_[rate_is_of_timeline_ ? 1 : 0] = per_second_->value();
    rate_is_of_timeline_ = shows_timeline();
    const QSignalBlocker blocker(per_second_);
    per_second_->setValue(rates_[rate_is_of_timeline_ ? 1 : 0]);
}

void FilmDialog::change() {
    choose_rate();
    result_->hide();
    refresh();
    const QString problem = why_not();
    const auto older = is_animation() ? 0 : film_files(folder_->text(), prefix_->text()).size();
    const QString film = animation_path(folder_->text(), prefix_->text());
    if (!problem.isEmpty())
        show_message(problem, "warning");
    else if (is_animation() && QFileInfo::exists(film))
        show_message(tr("%1 is there and will be replaced.").arg(QDir::toNativeSeparators(film)), "muted");
    else if (older > 0)
        show_message(older == 1
                         ? tr("1 picture of this name is there and will be replaced.")
                         : tr("%1 pictures of this name are there and will be replaced.").arg(format_count(older)),
                     "muted");
    else
        show_message({}, "");
}

void FilmDialog::show_message(const QString& text, const char* tone) {
    message_->setText(text);
    set_tone(message_, tone);
    message_->setVisible(!text.isEmpty());
}

void FilmDialog::start() {
    if (!why_not().isEmpty() || jobs_.runner().is_running()) return;
    remember();
    studio_ = std::make_unique<PictureStudio>(view_);
    drawn_ = picture_options();
    has_caption_ = caption_->isChecked();
    const Color& ink = view_.options().foreground;
    caption_color_ = QColor::fromRgbF(float(ink[0]), float(ink[1]), float(ink[2]));
    const Color& ground = view_.options().background;
    caption_ground_ = QColor::fromRgbF(float(ground[0]), float(ground[1]), float(ground[2]), 0.75f);
    FilmRequest request;
    request.source = shows_timeline()
                         ? film_of_timeline(filled_recording_, chosen<StepLevel>(level_), frames_->value())
                         : film_of_history(jobs_.document(), from_->currentData().toInt(), frames_->value());
    request.goes_back = back_->isChecked();
    request.folder = QDir(folder_->text()).absolutePath();
    request.prefix = prefix_->text();
    if (is_animation())
        request.animation = AnimationOptions{drawn_.size.width(), drawn_.size.height(), double(per_second_->value()),
                                             lossless_->isChecked(), double(quality_->value())};
    const QPointer<FilmDialog> self(this);
    request.draw = [self](const Frame& frame) { return self ? self->draw(frame) : QImage(); };
    request.then = [self](const FilmResult& result) {
        if (self) self->show_result(result);
    };
    result_->hide();
    is_writing_ = true;
    if (!jobs_.write_film(std::move(request))) is_writing_ = false;
    refresh();
}

QImage FilmDialog::draw(const Frame& frame) {
    if (!studio_) return {};
    QImage image = studio_->draw(frame.mesh, frame.quality ? &*frame.quality : nullptr, drawn_, frame.highlighted);
    if (image.isNull() || !has_caption_) return image;
    const double unit =
        std::min(double(image.width()) / view_.width(), double(image.height()) / view_.height()) * drawn_.line_scale;
    QPainter painter(&image);
    painter.setRenderHint(QPainter::TextAntialiasing);
    QFont font = this->font();
    font.setPixelSize(std::max(6, qRound(14 * unit)));
    painter.setFont(font);
    const QRectF place = QRectF(image.rect()).adjusted(12 * unit, 0, -12 * unit, -10 * unit);
    const QString text = QString::fromStdString(frame.caption);
    // Legible on whatever of the mesh is behind it.
    const QRectF words = painter.boundingRect(place, Qt::AlignLeft | Qt::AlignBottom, text);
    painter.fillRect(words.adjusted(-4 * unit, -2 * unit, 4 * unit, 2 * unit), caption_ground_);
    painter.setPen(caption_color_);
    painter.drawText(place, Qt::AlignLeft | Qt::AlignBottom, text);
    return image;
}

void FilmDialog::show_result(const FilmResult& result) {
    const QString folder = QDir(folder_->text()).absolutePath();
    const QString where = QDir::toNativeSeparators(is_animation() ? animation_path(folder, prefix_->text()) : folder);
    QString text =
        is_animation()
            ? tr("%1 pictures are in %2 (%3).")
                  .arg(format_count(result.pictures), where,
                       QLocale::c().formattedDataSize(static_cast<qint64>(result.bytes), 1, QLocale::DataSizeSIFormat))
            : tr("%1 pictures are in %2.").arg(format_count(result.pictures), where);
    if (!result.remark.isEmpty()) text += QLatin1Char(' ') + result.remark;
    show_message(text, result.remark.isEmpty() ? "good" : "warning");
    if (is_animation()) return;
    command_->setText(video_command(folder, prefix_->text(), per_second_->value(), drawn_.is_transparent));
    command_->setCursorPosition(0);
    command_->setToolTip(command_->text());
    video_button_->setVisible(!QStandardPaths::findExecutable(QStringLiteral("ffmpeg")).isEmpty());
    result_->show();
}

void FilmDialog::run_ffmpeg() {
    QStringList arguments{QStringLiteral("-y"), QStringLiteral("-loglevel"), QStringLiteral("error"),
                          QStringLiteral("-nostdin")};
    arguments << video_arguments(QDir(folder_->text()).absolutePath(), prefix_->text(), per_second_->value(),
                                 drawn_.is_transparent, video_);
    ffmpeg_.setProcessChannelMode(QProcess::MergedChannels);
    ffmpeg_.start(QStringLiteral("ffmpeg"), arguments);
    show_message(tr("Making %1…").arg(QDir::toNativeSeparators(video_)), "muted");
    refresh();
}

void FilmDialog::remember() const {
    size_->remember();
    QSettings settings;
    settings.setValue(setting("frames"), frames_->value());
    if (shows_timeline()) settings.setValue(setting("level"), level_->currentData());
    settings.setValue(setting(shows_timeline() ? "steps_per_second" : "per_second"), per_second_->value());
    settings.setValue(setting("animated"), is_animation());
    settings.setValue(setting("quality"), quality_->value());
    settings.setValue(setting("lossless"), lossless_->isChecked());
    settings.setValue(setting("back"), back_->isChecked());
    settings.setValue(setting("line_scale"), line_scale_->value());
    settings.setValue(setting("transparent"), transparent_->isChecked());
    if (legend_->isEnabled()) settings.setValue(setting("legend"), legend_->isChecked());
    settings.setValue(setting("caption"), caption_->isChecked());
    settings.setValue(setting("folder"), folder_->text());
}

}  // namespace curvewright
