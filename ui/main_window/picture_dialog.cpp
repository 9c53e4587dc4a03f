#include "ui/main_window/picture_dialog.h"

#include <QCheckBox>
#include <QClipboard>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "core/base/error.h"
#include "ui/jobs/picture_file.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/tiled_picture.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/size_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {

PreviewLabel::PreviewLabel(QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("picture_preview"));
    setMinimumSize(320, 240);
}

QSize PreviewLabel::room() const {
    return (QSizeF(size()) * devicePixelRatioF()).toSize();
}

void PreviewLabel::set_picture(const QImage& picture) {
    picture_ = picture;
    update();
}

void PreviewLabel::paintEvent(QPaintEvent*) {
    if (picture_.isNull()) return;
    QPainter painter(this);
    const QSizeF shown = QSizeF(picture_.size()) / devicePixelRatioF();
    const QRectF place(QPointF(0.5 * (width() - shown.width()), 0.5 * (height() - shown.height())), shown);
    if (picture_.hasAlphaChannel()) {
        constexpr int field = 8;
        const QColor light(255, 255, 255), dark(208, 208, 208);
        painter.save();
        painter.setClipRect(place);
        painter.fillRect(place, light);
        for (int row = 0; row * field < place.height(); ++row)
            for (int column = row % 2; column * field < place.width(); column += 2)
                painter.fillRect(QRectF(place.left() + column * field, place.top() + row * field, field, field), dark);
        painter.restore();
    }
    painter.drawImage(place, picture_);
    painter.setPen(palette().color(QPalette::Mid));
    painter.drawRect(place.adjusted(-0.5, -0.5, 0.5, 0.5));
}

PictureDialog::PictureDialog(MeshView& view, std::function<QString()> ask_path, QWidget* parent)
    : QDialog(parent), view_(view), ask_path_(std::move(ask_path)) {
    setObjectName(QStringLiteral("picture_dialog"));
    setWindowTitle(tr("Save a picture"));
    setAttribute(Qt::WA_DeleteOnClose);
    const QSettings settings;

    preview_ = new PreviewLabel;
    size_ = new SizeFields(QStringLiteral("picture"), false);
    size_->set_view_size(view.device_size());
    line_scale_ = make_number("picture_lines", 0.25, 8.0, 0.25, 2,
                              settings.value(QStringLiteral("picture/line_scale"), 1.0).toDouble());
    line_scale_->setPrefix(QStringLiteral("× "));
    line_scale_->setToolTip(tr(
        "Thickness of lines and size of text and points. At × 1 they grow with the picture: it looks like the view."));
    transparent_ = new QCheckBox(tr("Transparent ground"));
    transparent_->setObjectName(QStringLiteral("picture_transparent"));
    transparent_->setToolTip(tr("What is not the mesh is see-through, for slides and pages of any colour"));
    transparent_->setChecked(settings.value(QStringLiteral("picture/transparent"), false).toBool());
    legend_ = new QCheckBox(tr("Legend"));
    legend_->setObjectName(QStringLiteral("picture_legend"));
    legend_->setChecked(settings.value(QStringLiteral("picture/legend"), true).toBool());
    if (!view.options().show_legend) {
        legend_->setEnabled(false);
        legend_->setToolTip(tr("The view has no legend now: View > Legend"));
    }
    message_ = make_paragraph(QString(), "");
    message_->setObjectName(QStringLiteral("picture_message"));
    set_tone(message_, "warning");

    auto* form = make_form();
    form->addRow(tr("Size"), size_);
    form->addRow(tr("Lines and text"), line_scale_);
    form->addRow(QString(), transparent_);
    form->addRow(QString(), legend_);
    if (auto* label = qobject_cast<QLabel*>(form->labelForField(size_)))
        label->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    auto* side = new QVBoxLayout;
    side->setSpacing(8);
    side->addLayout(form);
    side->addWidget(message_);
    side->addStretch(1);
    auto* top = new QHBoxLayout;
    top->setSpacing(16);
    top->addWidget(preview_, 1);
    top->addLayout(side);

    save_ = make_primary_button(tr("Save…"), QStringLiteral("picture_save"));
    save_->setDefault(true);
    copy_ = new QPushButton(tr("Copy"));
    copy_->setObjectName(QStringLiteral("picture_copy"));
    copy_->setToolTip(tr("Put the picture on the clipboard"));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    buttons->addButton(copy_, QDialogButtonBox::ActionRole);
    buttons->addButton(save_, QDialogButtonBox::AcceptRole);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 12);
    layout->setSpacing(12);
    layout->addLayout(top, 1);
    progress_ = new QProgressBar;
    progress_->setObjectName(QStringLiteral("picture_progress"));
    stop_ = new QPushButton(tr("Stop"));
    stop_->setObjectName(QStringLiteral("picture_stop"));
    stop_->setToolTip(tr("Give up this picture (Esc)"));
    stop_->setAutoDefault(false);
    auto* under_way = new QHBoxLayout;
    under_way->setSpacing(8);
    under_way->addWidget(progress_, 1);
    under_way->addWidget(stop_);
    layout->addLayout(under_way);
    layout->addWidget(buttons);
    resize(680, 360);

    preview_timer_.setSingleShot(true);
    preview_timer_.setInterval(100);
    connect(&preview_timer_, &QTimer::timeout, this, &PictureDialog::draw_preview);
    connect(size_, &SizeFields::changed, this, &PictureDialog::refresh);
    connect(line_scale_, &QDoubleSpinBox::valueChanged, this, &PictureDialog::refresh);
    connect(transparent_, &QCheckBox::toggled, this, &PictureDialog::refresh);
    connect(legend_, &QCheckBox::toggled, this, &PictureDialog::refresh);
    connect(&view, &MeshView::camera_moved, this, &PictureDialog::refresh);
    connect(save_, &QPushButton::clicked, this, &PictureDialog::save);
    connect(copy_, &QPushButton::clicked, this, &PictureDialog::copy);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(stop_, &QPushButton::clicked, this, &PictureDialog::stop);
    connect(&runner_, &JobRunner::cancelled, this, &PictureDialog::refresh);
    connect(&runner_, &JobRunner::failed, this, [this](const QString&, const QString& text) {
        refresh();
        emit failed(text);
    });
    refresh();
}

PictureDialog::~PictureDialog() = default;

PictureOptions PictureDialog::options() const {
    PictureOptions options;
    options.size = size_->picture_size();
    options.line_scale = line_scale_->value();
    options.is_transparent = transparent_->isChecked();
    options.has_legend = legend_->isChecked();
    return options;
}

void PictureDialog::refresh() {
    const QString problem = why_no_picture(size_->picture_size(), view_.largest_picture_side());
    message_->setText(problem);
    message_->setVisible(!problem.isEmpty());
    for (QPushButton* button : {save_, copy_}) button->setEnabled(problem.isEmpty() && !is_busy());
    progress_->setVisible(is_busy());
    stop_->setVisible(is_busy());
    if (!is_busy()) {
        progress_->setRange(0, 100);
        preview_timer_.start();
    }
}

void PictureDialog::draw_preview() {
    PictureOptions small = options();
    const QSize room = preview_->room() - QSize(2, 2);
    small.size = small.size.scaled(room, Qt::KeepAspectRatio).expandedTo({1, 1});
    if (!view_.is_large()) return preview_->set_picture(view_.picture(small));
    preview_drawing_ = std::make_unique<TiledPicture>(view_, small);
    connect(preview_drawing_.get(), &TiledPicture::finished, this, [this](const QImage& image) {
        preview_drawing_.release()->deleteLater();
        preview_->set_picture(image);
    });
}

void PictureDialog::draw(std::function<void(const QImage&)> then) {
    preview_timer_.stop();
    preview_drawing_.reset();
    drawing_ = std::make_unique<TiledPicture>(view_, options());
    connect(drawing_.get(), &TiledPicture::progress, progress_,
            [this](double fraction) { progress_->setValue(static_cast<int>(100.0 * fraction)); });
    connect(drawing_.get(), &TiledPicture::finished, this, [this, then = std::move(then)](const QImage& image) {
        // It is the one who tells this.
        drawing_.release()->deleteLater();
        if (!image.isNull()) then(image);
        refresh();
        if (!image.isNull()) return;
        emit failed(tr("The picture could not be drawn: there is not enough graphics memory for %1 × %2 pixels.")
                        .arg(size_->picture_size().width())
                        .arg(size_->picture_size().height()));
    });
    progress_->setValue(0);
    refresh();
}

void PictureDialog::stop() {
    drawing_.reset();
    runner_.cancel();
    refresh();
}

void PictureDialog::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape && is_busy())
        stop();
    else
        QDialog::keyPressEvent(event);
}

void PictureDialog::save() {
    QString path = ask_path_();
    if (path.isEmpty()) return;
    if (QFileInfo(path).suffix().isEmpty()) path += QStringLiteral(".png");
    draw([this, path](const QImage& image) { write(path, image); });
}

void PictureDialog::write(const QString& path, const QImage& image) {
    remember();
    runner_.start(tr("Writing %1").arg(QFileInfo(path).fileName()), [this, path, image](const TaskContext& context) {
        write_bytes(path, encode_png(image), context);
        return [this, path, size = image.size()] {
            emit saved(path, size);
            accept();
        };
    });
    progress_->setRange(0, 0);
    refresh();
}

void PictureDialog::copy() {
    draw([this](const QImage& image) {
        remember();
        // What other programs understand best.
        QGuiApplication::clipboard()->setImage(
            image.convertToFormat(image.hasAlphaChannel() ? QImage::Format_ARGB32 : QImage::Format_RGB32));
        emit saved({}, image.size());
    });
}

void PictureDialog::remember() const {
    size_->remember();
    QSettings settings;
    settings.setValue(QStringLiteral("picture/line_scale"), line_scale_->value());
    settings.setValue(QStringLiteral("picture/transparent"), transparent_->isChecked());
    if (legend_->isEnabled()) settings.setValue(QStringLiteral("picture/legend"), legend_->isChecked());
}

}  // namespace curvewright
