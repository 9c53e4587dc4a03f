#include "ui/panels/start_page.h"

#include <QDir>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

constexpr int page_width = 880, columns = 4;
constexpr QSize thumbnail_size(196, 132);

/// A picture, a title and two lines, all of it one button.
class SampleCard : public QFrame {
  public:
    SampleCard(const Sample& sample, std::function<void()> choose) : choose_(std::move(choose)) {
        setObjectName(QStringLiteral("sample_card"));
        setAccessibleName(sample.title);
        setProperty("sample", sample.name);
        setCursor(Qt::PointingHandCursor);
        setFocusPolicy(Qt::TabFocus);
        setToolTip(sample.description);

        auto* picture = new QLabel;
        picture->setFixedHeight(thumbnail_size.height());
        picture->setAlignment(Qt::AlignCenter);
        const QPixmap thumbnail(sample.thumbnail_path);
        if (!thumbnail.isNull())
            picture->setPixmap(rounded(thumbnail));
        else
            picture->setText(tr("P%1, %2D").arg(sample.order).arg(sample.dimension));

        QString task = sample.task == Sample::Task::untangle ? tr("Untangle") : tr("Warp");
        if (!sample.figures.isEmpty()) task = tr("%1 · %2").arg(task, sample.figures_text());
        if (!sample.is_there()) task = tr("Made on demand");
        auto* facts = make_label(
            tr("P%1 · %2D · %3 elements").arg(sample.order).arg(sample.dimension).arg(format_count(sample.elements)),
            "muted");
        facts->setFont(Theme::small_font());
        auto* title = make_label(sample.title, "title");
        auto* task_label = make_label(task, "");
        task_label->setFont(Theme::small_font());
        task_label->setProperty("role", QStringLiteral("section"));
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(4, 4, 4, 12);
        layout->setSpacing(0);
        layout->addWidget(picture);
        auto* text = new QVBoxLayout;
        text->setContentsMargins(8, 8, 8, 0);
        text->setSpacing(2);
        text->addWidget(title);
        text->addWidget(facts);
        text->addWidget(task_label);
        layout->addLayout(text);
    }

  protected:
    void mouseReleaseEvent(QMouseEvent* event) override {
        if (event->button() == Qt::LeftButton && rect().contains(event->position().toPoint())) choose_();
    }
    void keyPressEvent(QKeyEvent* event) override {
        if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter || event->key() == Qt::Key_Space)
            choose_();
        else
            QFrame::keyPressEvent(event);
    }

  private:
    QPixmap rounded(const QPixmap& source) const {
        const qreal ratio = devicePixelRatioF();
        const QPixmap scaled =
            source.scaled(thumbnail_size * ratio, Qt::KeepAspectRatioByExpanding, Qt::SmoothTransformation);
        QPixmap result(thumbnail_size * ratio);
        result.fill(Qt::transparent);
        QPainter painter(&result);
        painter.setRenderHint(QPainter::Antialiasing);
        QPainterPath path;
        path.addRoundedRect(QRectF(QPointF(0, 0), QSizeF(result.size())), 6 * ratio, 6 * ratio);
        painter.setClipPath(path);
        painter.drawPixmap((result.width() - scaled.width()) / 2, (result.height() - scaled.height()) / 2, scaled);
        painter.end();
        result.setDevicePixelRatio(ratio);
        return result;
    }

    std::function<void()> choose_;
};

}  // namespace

StartPage::StartPage(const SampleCatalog& samples, RecentFiles& recent, const Theme& theme, QWidget* parent)
    : QWidget(parent), recent_(recent), theme_(theme) {
    setObjectName(QStringLiteral("start_page"));
    setAttribute(Qt::WA_StyledBackground);

    auto* page = new QWidget;
    page->setFixedWidth(page_width);
    auto* column = new QVBoxLayout(page);
    column->setContentsMargins(0, 24, 0, 24);
    column->setSpacing(12);
    auto* title = make_label(tr("Open a curved mesh"), "title");
    title->setFont(Theme::large_font());
    column->addWidget(title);
    column->addWidget(make_drop_zone());

    recent_section_ = new QWidget;
    auto* recent_column = new QVBoxLayout(recent_section_);
    recent_column->setContentsMargins(0, 8, 0, 0);
    recent_column->setSpacing(4);
    recent_column->addWidget(make_label(tr("Recent files"), "section"));
    recent_list_ = new QVBoxLayout;
    recent_list_->setSpacing(0);
    recent_column->addLayout(recent_list_);
    column->addWidget(recent_section_);

    column->addSpacing(8);
    column->addWidget(make_label(tr("Samples"), "title"));
    if (samples.samples().isEmpty()) column->addWidget(make_paragraph(samples.error(), "muted"));
    for (const int chapter : samples.chapters()) {
        column->addWidget(make_label(chapter_title(chapter), "section"));
        column->addWidget(make_gallery(samples.of_chapter(chapter)));
        column->addSpacing(12);
    }
    column->addStretch();

    auto* center = new QWidget;
    auto* center_layout = new QHBoxLayout(center);
    center_layout->addStretch();
    center_layout->addWidget(page);
    center_layout->addStretch();
    auto* scroll = new QScrollArea;
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setFocusPolicy(Qt::NoFocus);  // Tab goes to what is in it
    scroll->setWidget(center);
    scroll->viewport()->setAutoFillBackground(false);
    center->setAutoFillBackground(false);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(scroll);

    connect(&recent, &RecentFiles::changed, this, &StartPage::show_recent);
    show_recent();
}

QWidget* StartPage::make_drop_zone() {
    drop_zone_ = new QWidget;
    drop_zone_->setObjectName(QStringLiteral("drop_zone"));
    drop_zone_->setAttribute(Qt::WA_StyledBackground);
    auto* icon = new QLabel;
    icon->setFixedSize(32, 32);
    auto* button = new QPushButton(tr("Open…"));
    button->setObjectName(QStringLiteral("start_open"));
    button->setProperty("primary", true);
    auto* text = new QVBoxLayout;
    text->setSpacing(4);
    text->addWidget(make_label(tr("Drop a mesh here"), "title"));
    text->addWidget(
        make_label(tr("Gmsh .msh and .msh.gz, VTK .vtu and .vtk: meshes of order 1 to 10, in 2D and 3D"), "muted"));
    auto* layout = new QHBoxLayout(drop_zone_);
    layout->setContentsMargins(24, 24, 24, 24);
    layout->setSpacing(16);
    layout->addWidget(icon);
    layout->addLayout(text, 1);
    layout->addWidget(button);

    const auto paint_icon = [this, icon] { icon->setPixmap(theme_.icon(QStringLiteral("drop")).pixmap(32)); };
    paint_icon();
    connect(&theme_, &Theme::changed, this, paint_icon);
    connect(button, &QPushButton::clicked, this, &StartPage::open_requested);
    return drop_zone_;
}

QWidget* StartPage::make_gallery(const QVector<Sample>& samples) {
    auto* gallery = new QWidget;
    auto* grid = new QGridLayout(gallery);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(12);
    int position = 0;
    for (const Sample& sample : samples) {
        grid->addWidget(new SampleCard(sample, [this, sample] { emit sample_chosen(sample); }), position / columns,
                        position % columns);
        ++position;
    }
    for (int column = 0; column < columns; ++column) grid->setColumnStretch(column, 1);
    return gallery;
}

void StartPage::show_recent() {
    while (QLayoutItem* item = recent_list_->takeAt(0)) {
        if (item->widget()) item->widget()->deleteLater();
        if (item->layout()) {
            while (QLayoutItem* inner = item->layout()->takeAt(0)) {
                if (inner->widget()) inner->widget()->deleteLater();
                delete inner;
            }
        }
        delete item;
    }
    const QStringList paths = recent_.paths().mid(0, 4);
    recent_section_->setVisible(!paths.isEmpty());
    for (const QString& path : paths) {
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        auto* button = new QPushButton(QFileInfo(path).fileName());
        button->setObjectName(QStringLiteral("recent_file"));
        button->setProperty("link", true);
        button->setCursor(Qt::PointingHandCursor);
        button->setToolTip(QDir::toNativeSeparators(path));
        auto* folder = make_label(QDir::toNativeSeparators(QFileInfo(path).absolutePath()), "muted");
        folder->setFont(Theme::small_font());
        row->addWidget(button);
        row->addWidget(folder, 1);
        recent_list_->addLayout(row);
        connect(button, &QPushButton::clicked, this, [this, path] { emit file_chosen(path); });
    }
}

void StartPage::set_drop_active(bool is_active) {
    drop_zone_->setProperty("active", is_active);
    restyle(drop_zone_);
}

}  // namespace curvewright
