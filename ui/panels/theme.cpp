#include "ui/panels/theme.h"

#include <QApplication>
#include <QFile>
#include <QFont>
#include <QIconEngine>
#include <QJsonDocument>
#include <QJsonObject>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QRegularExpression>
#include <QStyleFactory>
#include <QSvgRenderer>
#include <QTimer>
#include <QWidget>

static void load_resources() {
    Q_INIT_RESOURCE(curvewright);
}

namespace curvewright {
namespace {

QByteArray read_resource(const QString& name) {
    QFile file(QStringLiteral(":/curvewright/") + name);
    if (!file.open(QIODevice::ReadOnly)) qFatal("Resource %s is missing.", qPrintable(name));
    return file.readAll();
}

/// Draws an SVG at whatever size is asked for, so that lines are crisp on every screen.
class LineIconEngine : public QIconEngine {
  public:
    LineIconEngine(QByteArray normal, QByteArray disabled)
        : normal_(std::move(normal)), disabled_(std::move(disabled)) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
        QSvgRenderer(mode == QIcon::Disabled ? disabled_ : normal_).render(painter, rect);
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect(QPoint(0, 0), size), mode, state);
        return pixmap;
    }
    QSize actualSize(const QSize& size, QIcon::Mode, QIcon::State) override { return size; }
    QIconEngine* clone() const override { return new LineIconEngine(*this); }

  private:
    QByteArray normal_, disabled_;
};

/// What widgets ask for when they are made, before they belong to a window that has the style sheet.
class BaseStyle : public QProxyStyle {
  public:
    BaseStyle() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

    int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                  QStyleHintReturn* data) const override {
        if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
        return QProxyStyle::styleHint(hint, option, widget, data);
    }
};

}  // namespace

Theme::Theme(QApplication& application) : application_(application) {
    load_resources();
    is_system_dark_ = application.palette().color(QPalette::Window).lightness() < 128;
    application.setStyle(new BaseStyle);
    set_choice(Choice::follow_system);
}

void Theme::set_choice(Choice choice) {
    choice_ = choice;
    is_dark_ = choice == Choice::dark || (choice == Choice::follow_system && is_system_dark_);
    const QJsonObject palettes = QJsonDocument::fromJson(read_resource(QStringLiteral("palette.json"))).object();
    const QJsonObject chosen = palettes.value(is_dark_ ? QLatin1String("dark") : QLatin1String("light")).toObject();
    colors_.clear();
    for (auto entry = chosen.begin(); entry != chosen.end(); ++entry)
        colors_.insert(entry.key(), QColor(entry.value().toString()));

    QPalette palette;
    const auto set = [&](QPalette::ColorRole role, const char* name) {
        palette.setColor(role, color(QLatin1String(name)));
    };
    set(QPalette::Window, "window");
    set(QPalette::WindowText, "text");
    set(QPalette::Base, "surface");
    set(QPalette::AlternateBase, "surface_alternate");
    set(QPalette::Text, "text");
    set(QPalette::Button, "window");
    set(QPalette::ButtonText, "text");
    set(QPalette::BrightText, "alarm");
    set(QPalette::ToolTipBase, "surface");
    set(QPalette::ToolTipText, "text");
    set(QPalette::PlaceholderText, "text_muted");
    set(QPalette::Highlight, "accent");
    set(QPalette::HighlightedText, "accent_text");
    set(QPalette::Link, "accent");
    set(QPalette::LinkVisited, "accent");
    set(QPalette::Mid, "border");
    set(QPalette::Dark, "border_strong");
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, color(QStringLiteral("text_disabled")));
    application_.setPalette(palette);
    const QString sheet = style_sheet();
    for (QWidget* window : windows_) {
        window->setUpdatesEnabled(false);
        window->setStyleSheet(sheet);
    }
    emit changed();
    // The repaint takes as long again: in a turn of its own.
    QTimer::singleShot(1, this, [this] {
        for (QWidget* window : windows_) window->setUpdatesEnabled(true);
    });
}

void Theme::dress(QWidget* window) {
    windows_.push_back(window);
    connect(window, &QObject::destroyed, this, [this, window] { std::erase(windows_, window); });
    window->setStyleSheet(style_sheet());
}

QColor Theme::color(const QString& name) const {
    const auto found = colors_.constFind(name);
    if (found == colors_.constEnd()) qFatal("palette.json has no colour %s.", qPrintable(name));
    return *found;
}

QByteArray Theme::recolored(const QString& icon_name, const QColor& line, const QColor& accent) const {
    QByteArray svg = read_resource(QStringLiteral("icons/%1.svg").arg(icon_name));
    svg.replace("currentColor", line.name().toLatin1());
    svg.replace("accentColor", accent.name().toLatin1());
    return svg;
}

QIcon Theme::icon(const QString& name) const {
    return icon(name, QStringLiteral("text"));
}

QIcon Theme::icon(const QString& name, const QString& color_name) const {
    if (name.isEmpty()) return {};
    const QColor disabled = color(QStringLiteral("text_disabled"));
    return QIcon(new LineIconEngine(recolored(name, color(color_name), color(QStringLiteral("accent"))),
                                    recolored(name, disabled, disabled)));
}

QIcon Theme::program_icon() {
    load_resources();
    return QIcon(QStringLiteral(":/curvewright/icons/curvewright.svg"));
}

QFont Theme::small_font() {
    QFont font = QApplication::font();
    if (font.pointSizeF() > 0) font.setPointSizeF(font.pointSizeF() - 1.0);
    return font;
}

QFont Theme::large_font() {
    QFont font = QApplication::font();
    if (font.pointSizeF() > 0) font.setPointSizeF(font.pointSizeF() * 1.5);
    return font;
}

QString Theme::style_sheet() const {
    QString sheet = QString::fromUtf8(read_resource(QStringLiteral("style.qss")));
    const struct {
        const char *name, *icon, *line;
    } images[] = {{"arrow", "arrow", "text_muted"},  {"arrow_up", "arrow_up", "text_muted"},
                  {"check", "check", "accent_text"}, {"tick", "check", "text"},
                  {"help", "help", "accent"},        {"alert", "alert", "warning"}};
    for (const auto& image : images) {
        const QString name = QLatin1String(image.name);
        const QString path =
            icon_files_.filePath(QStringLiteral("%1_%2.svg").arg(name, is_dark_ ? QStringLiteral("dark") : QString()));
        QFile file(path);
        if (file.open(QIODevice::WriteOnly)) {
            const QColor line = color(QLatin1String(image.line));
            file.write(recolored(QLatin1String(image.icon), line, line));
        }
        sheet.replace(QRegularExpression(QStringLiteral("@icon_%1\\b").arg(name)), path);
    }
    static const QRegularExpression name_pattern(QStringLiteral("@([a-z_]+)"));
    QString result;
    qsizetype end = 0;
    for (auto match = name_pattern.globalMatch(sheet, sheet.indexOf(QLatin1String("*/"))); match.hasNext();) {
        const QRegularExpressionMatch found = match.next();
        result += sheet.mid(end, found.capturedStart() - end) + color(found.captured(1)).name();
        end = found.capturedEnd();
    }
    return result + sheet.mid(end);
}

}  // namespace curvewright
