#include "ui/panels/color_bar.h"

#include <algorithm>
#include <cmath>

#include <QComboBox>
#include <QDoubleValidator>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QSettings>
#include <QStandardItemModel>
#include <QToolButton>
#include <QUrl>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/palette/quality_colors.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

using Kind = ColorSetting::Kind;

const QString quantity_setting = QStringLiteral("colors/quantity");

QString setting_name(const QString& key, const char* what) {
    return QStringLiteral("colors/of/%1/%2").arg(key, QLatin1String(what));
}

QString map_text(ColorMap map) {
    switch (map) {
        case ColorMap::warm:
            return ColorBar::tr("Warm");
        case ColorMap::deep:
            return ColorBar::tr("Deep");
        case ColorMap::balance:
            return ColorBar::tr("Balance");
        case ColorMap::grey:
            return ColorBar::tr("Grey");
    }
    return {};
}

QString map_tip(ColorMap map) {
    switch (map) {
        case ColorMap::warm:
            return ColorBar::tr("Orange to pale: what is low stands out");
        case ColorMap::deep:
            return ColorBar::tr("Dark blue over green to yellow: for ordinary numbers");
        case ColorMap::balance:
            return ColorBar::tr("Blue over light grey to orange: for numbers on either side of a middle");
        case ColorMap::grey:
            return ColorBar::tr("Dark to light grey: leaves colour to the marks");
    }
    return {};
}

QIcon map_icon(ColorMap map, bool is_reversed, const QColor& outline) {
    constexpr int width = 32, height = 14;
    QPixmap pixmap(width, height);
    QPainter painter(&pixmap);
    for (int x = 0; x < width; ++x) {
        const double t = (x + 0.5) / width;
        const Color color = map_color(map, is_reversed ? 1.0 - t : t);
        painter.fillRect(x, 0, 1, height, QColor::fromRgbF(float(color[0]), float(color[1]), float(color[2])));
    }
    painter.setPen(outline);
    painter.drawRect(0, 0, width - 1, height - 1);
    painter.end();
    QIcon icon(pixmap);
    icon.addPixmap(pixmap, QIcon::Selected);
    return icon;
}

ColorMap default_map(Kind kind) {
    return kind == Kind::size || kind == Kind::array ? ColorMap::deep : ColorMap::warm;
}

/// What has not moved is quiet.
bool is_reversed_first(Kind kind) {
    return kind == Kind::distance_moved;
}

std::optional<double> number_of(const QVariant& value) {
    bool is_number = false;
    const double number = value.toString().toDouble(&is_number);
    return is_number && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

QLineEdit* make_end(const char* object_name, const QString& tip) {
    auto* field = new QLineEdit;
    field->setObjectName(QLatin1String(object_name));
    field->setToolTip(tip);
    field->setFixedWidth(76);
    field->setClearButtonEnabled(true);
    auto* validator = new QDoubleValidator(field);
    validator->setLocale(QLocale::c());
    field->setValidator(validator);
    return field;
}

}  // namespace

ColorBar::ColorBar(MeshDocument& document, const Theme& theme, QWidget* parent)
    : QWidget(parent), document_(document), theme_(theme) {
    setObjectName(QStringLiteral("color_bar"));
    setAttribute(Qt::WA_StyledBackground);
    setFocusPolicy(Qt::ClickFocus);
    quantity_ = new QComboBox;
    quantity_->setObjectName(QStringLiteral("color_quantity"));
    quantity_->setToolTip(tr("What the colours show"));
    quantity_->setMaxVisibleItems(20);
    quantity_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    quantity_->setMinimumContentsLength(16);
    component_ = new QComboBox;
    component_->setObjectName(QStringLiteral("color_component"));
    component_->setToolTip(tr("Length of the vectors, or one of their components"));
    component_->hide();
    map_ = new QComboBox;
    map_->setObjectName(QStringLiteral("color_map"));
    map_->setIconSize({32, 14});
    for (const ColorMap map : color_maps) {
        map_->addItem(map_text(map), static_cast<int>(map));
        map_->setItemData(map_->count() - 1, map_tip(map), Qt::ToolTipRole);
    }
    map_->setToolTip(tr("The map of colours; all of them are safe for the colour-blind"));
    reverse_ = new QToolButton;
    reverse_->setObjectName(QStringLiteral("color_reverse"));
    reverse_->setCheckable(true);
    reverse_->setFixedSize(26, 26);
    reverse_->setToolTip(tr("Turn the map round"));
    close_ = new QToolButton;
    close_->setObjectName(QStringLiteral("color_close"));
    close_->setToolTip(tr("Close; the colours stay"));
    close_->setAutoRaise(true);
    close_->setFixedSize(26, 26);
    lower_ = make_end("color_lower", tr("Lower end of the range; empty: automatic"));
    upper_ = make_end("color_upper", tr("Upper end of the range; empty: automatic"));

    auto* first = new QHBoxLayout;
    first->setSpacing(4);
    first->addWidget(make_label(tr("Colours"), "muted"));
    first->addWidget(quantity_, 1);
    first->addWidget(component_);
    first->addWidget(close_);
    scale_row_ = new QWidget;
    auto* second = new QHBoxLayout(scale_row_);
    second->setContentsMargins(0, 0, 0, 0);
    second->setSpacing(4);
    second->addWidget(map_);
    second->addWidget(reverse_);
    second->addStretch(1);
    second->addWidget(lower_);
    second->addWidget(make_label(tr("to"), "muted"));
    second->addWidget(upper_);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(8, 4, 8, 6);
    layout->setSpacing(4);
    layout->addLayout(first);
    layout->addWidget(scale_row_);

    connect(quantity_, &QComboBox::currentIndexChanged, this, [this] {
        if (!is_showing_) choose_quantity(true);
    });
    connect(component_, &QComboBox::currentIndexChanged, this, [this](int index) {
        if (!is_showing_) set_component(index - 1);
    });
    connect(map_, &QComboBox::currentIndexChanged, this, &ColorBar::choose_map);
    connect(reverse_, &QToolButton::toggled, this, &ColorBar::choose_map);
    for (QLineEdit* end : {lower_, upper_}) {
        connect(end, &QLineEdit::editingFinished, this, &ColorBar::read_range);
        // The clear button.
        connect(end, &QLineEdit::textChanged, this, [this](const QString& text) {
            if (text.isEmpty()) read_range();
        });
    }
    connect(close_, &QToolButton::clicked, this, &ColorBar::close_requested);
    connect(&theme, &Theme::changed, this, &ColorBar::paint_icons);
    refresh();
}

std::vector<ColorBar::Quantity> ColorBar::quantities() const {
    const int dim = document_.has_mesh() ? document_.state().mesh->topology().dimension() : 2;
    std::vector<Quantity> list = {
        {Kind::scaled_jacobian, -1, QStringLiteral("scaled_jacobian"), tr("Scaled Jacobian"),
         tr("min J / max J of every element")},
        {Kind::plain, -1, QStringLiteral("plain"), tr("One colour"), tr("Only tangled elements stand out")},
        {Kind::shape, -1, QStringLiteral("shape"), tr("Shape"),
         tr("Worst mean ratio of every element against the straight-sided one of the opened mesh: 1 is similar to it, "
            "0 "
            "flat")},
        {Kind::size, -1, QStringLiteral("size"),
         dim == 3   ? tr("Volume")
         : dim == 2 ? tr("Area")
                    : tr("Length"),
         tr("Of every curved element")},
        {Kind::distance_moved, -1, QStringLiteral("distance_moved"), tr("Distance moved"),
         tr("Of every point since the mesh was opened")}};
    const std::vector<FieldArray>& fields = *document_.fields();
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const bool is_on_nodes = fields[i].place == FieldArray::Place::nodes;
        const QString name = QString::fromStdString(fields[i].name);
        list.push_back({Kind::array, static_cast<int>(i),
                        (is_on_nodes ? QStringLiteral("nodes-") : QStringLiteral("elements-")) +
                            QString::fromLatin1(QUrl::toPercentEncoding(name)),
                        is_on_nodes ? tr("%1 (nodes)").arg(name) : tr("%1 (elements)").arg(name),
                        tr("An array of the file")});
    }
    return list;
}

const ColorBar::Quantity& ColorBar::chosen() const {
    return list_[static_cast<std::size_t>(std::max(0, quantity_->currentData().toInt()))];
}

void ColorBar::refresh() {
    list_ = quantities();
    const QString wanted = QSettings().value(quantity_setting).toString();
    is_showing_ = true;
    quantity_->clear();
    for (std::size_t i = 0; i < list_.size(); ++i) {
        if (list_[i].array == 0) quantity_->insertSeparator(quantity_->count());
        quantity_->addItem(list_[i].text, static_cast<int>(i));
        quantity_->setItemData(quantity_->count() - 1, list_[i].tip, Qt::ToolTipRole);
        if (list_[i].key == wanted) quantity_->setCurrentIndex(quantity_->count() - 1);
    }
    // What cannot be had of this mesh.
    const bool is_assessable = !document_.has_mesh() || document_.state().quality;
    auto* model = static_cast<QStandardItemModel*>(quantity_->model());
    for (int row = 0; row < quantity_->count(); ++row)
        if (list_[static_cast<std::size_t>(std::max(0, quantity_->itemData(row).toInt()))].kind == Kind::shape &&
            quantity_->itemData(row).isValid())
            model->item(row)->setEnabled(is_assessable);
    if (chosen().kind == Kind::shape && !is_assessable) quantity_->setCurrentIndex(0);
    is_showing_ = false;
    choose_quantity(false);
}

void ColorBar::choose_quantity(bool by_user) {
    const Quantity& quantity = chosen();
    load(quantity);
    if (by_user) QSettings().setValue(quantity_setting, quantity.key);
    show_setting();
    find_quality_scale();
    emit changed();
}

void ColorBar::load(const Quantity& quantity) {
    const QSettings settings;
    setting_ = {};
    setting_.kind = quantity.kind;
    setting_.array = quantity.array;
    const auto value = [&](const char* what) { return settings.value(setting_name(quantity.key, what)); };
    setting_.map = color_map_of(value("map").toString().toStdString()).value_or(default_map(quantity.kind));
    setting_.is_reversed =
        settings.value(setting_name(quantity.key, "reversed"), is_reversed_first(quantity.kind)).toBool();
    setting_.lower = number_of(value("lower"));
    setting_.upper = number_of(value("upper"));
    if (setting_.lower && setting_.upper && *setting_.lower >= *setting_.upper) setting_.lower = setting_.upper = {};
    if (quantity.kind == Kind::array) {
        const FieldArray& field = (*document_.fields())[static_cast<std::size_t>(quantity.array)];
        bool is_number = false;
        const int component = value("component").toInt(&is_number);
        if (is_number && component < field.components) setting_.component = std::max(-1, component);
    }
    is_showing_ = true;
    component_->clear();
    if (quantity.kind == Kind::array) {
        const int components = (*document_.fields())[static_cast<std::size_t>(quantity.array)].components;
        component_->addItem(tr("Length"));
        const QString axes[] = {tr("x"), tr("y"), tr("z")};
        for (int c = 0; components > 1 && c < components; ++c)
            component_->addItem(components <= 3 ? axes[c] : QString::number(c + 1));
    }
    component_->setVisible(component_->count() > 1);
    component_->setCurrentIndex(setting_.component + 1);
    is_showing_ = false;
    set_component(setting_.component);
}

void ColorBar::set_component(int component) {
    const Quantity& quantity = chosen();
    const bool is_changed = setting_.component != component;
    setting_.component = component;
    switch (quantity.kind) {
        case Kind::scaled_jacobian:
            break;  // the legend knows
        case Kind::plain:
            setting_.title = quantity.text;
            break;
        case Kind::shape:
            setting_.title = quantity.text;
            setting_.detail = tr("mean ratio");
            break;
        case Kind::size:
            setting_.title = quantity.text;
            setting_.detail = tr("of elements");
            break;
        case Kind::distance_moved:
            setting_.title = quantity.text;
            setting_.detail = tr("since opened");
            break;
        case Kind::array: {
            const FieldArray& field = (*document_.fields())[static_cast<std::size_t>(quantity.array)];
            setting_.title = QString::fromStdString(field.name);
            if (field.components > 1)
                setting_.detail =
                    component < 0 ? tr("length") : tr("component %1").arg(component_->itemText(component + 1));
            else
                setting_.detail = field.place == FieldArray::Place::nodes ? tr("nodes") : tr("elements");
            break;
        }
    }
    if (!is_changed) return;
    save();
    emit changed();
}

void ColorBar::choose_map() {
    if (is_showing_) return;
    setting_.map = static_cast<ColorMap>(map_->currentData().toInt());
    setting_.is_reversed = reverse_->isChecked();
    save();
    paint_icons();
    find_quality_scale();
    emit changed();
}

void ColorBar::read_range() {
    if (is_showing_) return;
    const auto given = [](const QLineEdit* field) { return number_of(field->text()); };
    const auto lower = given(lower_), upper = given(upper_);
    // The other end may be automatic: then it is what is shown.
    const double low = lower.value_or(shown_lower_), high = upper.value_or(shown_upper_);
    const bool is_empty = (lower || upper) && !(low < high);
    for (QLineEdit* field : {lower_, upper_}) {
        field->setProperty("wrong", is_empty);
        restyle(field);
    }
    if (is_empty || (lower == setting_.lower && upper == setting_.upper)) return;
    setting_.lower = lower;
    setting_.upper = upper;
    save();
    find_quality_scale();
    emit changed();
}

void ColorBar::show_range(double lower, double upper) {
    shown_lower_ = lower;
    shown_upper_ = upper;
    // As many digits as tell the ends apart.
    const double size = std::max(std::abs(lower), std::abs(upper)), extent = upper - lower;
    const int digits = extent > 0.0 && size > 0.0 ? static_cast<int>(std::ceil(std::log10(size / extent))) : 0;
    for (const auto& [field, value] : {std::pair(lower_, lower), std::pair(upper_, upper)})
        field->setPlaceholderText(
            QString::number(std::abs(value) < 1e-9 * extent ? 0.0 : value, 'g', std::clamp(digits, 0, 12) + 3));
}

void ColorBar::show_waiting() {
    for (QLineEdit* field : {lower_, upper_}) field->setPlaceholderText(QStringLiteral("…"));
}

void ColorBar::show_setting() {
    is_showing_ = true;
    map_->setCurrentIndex(map_->findData(static_cast<int>(setting_.map)));
    reverse_->setChecked(setting_.is_reversed);
    const auto text = [](const std::optional<double>& value) {
        return value ? QString::number(*value, 'g', 10) : QString();
    };
    lower_->setText(text(setting_.lower));
    upper_->setText(text(setting_.upper));
    for (QLineEdit* field : {lower_, upper_}) {
        field->setProperty("wrong", false);
        restyle(field);
    }
    scale_row_->setEnabled(setting_.kind != Kind::plain);
    is_showing_ = false;
    paint_icons();
}

void ColorBar::save() const {
    QSettings settings;
    const QString& key = chosen().key;
    settings.setValue(setting_name(key, "map"), QLatin1String(to_string(setting_.map)));
    settings.setValue(setting_name(key, "reversed"), setting_.is_reversed);
    for (const auto& [name, value] : {std::pair("lower", setting_.lower), std::pair("upper", setting_.upper)})
        if (value)
            settings.setValue(setting_name(key, name), QString::number(*value, 'g', 17));
        else
            settings.remove(setting_name(key, name));
    if (setting_.kind == Kind::array) settings.setValue(setting_name(key, "component"), setting_.component);
}

void ColorBar::find_quality_scale() {
    if (setting_.kind == Kind::scaled_jacobian) {
        quality_scale_ = {setting_.map, setting_.is_reversed, setting_.lower.value_or(0.0),
                          setting_.upper.value_or(1.0)};
        return;
    }
    const QSettings settings;
    const QString key = QStringLiteral("scaled_jacobian");
    quality_scale_ = {
        color_map_of(settings.value(setting_name(key, "map")).toString().toStdString()).value_or(ColorMap::warm),
        settings.value(setting_name(key, "reversed")).toBool(),
        number_of(settings.value(setting_name(key, "lower"))).value_or(0.0),
        number_of(settings.value(setting_name(key, "upper"))).value_or(1.0)};
}

void ColorBar::paint_icons() {
    close_->setIcon(theme_.icon(QStringLiteral("close")));
    reverse_->setIcon(theme_.icon(QStringLiteral("reverse")));
    for (int i = 0; i < map_->count(); ++i)
        map_->setItemIcon(i, map_icon(static_cast<ColorMap>(map_->itemData(i).toInt()), reverse_->isChecked(),
                                      theme_.color(QStringLiteral("border_strong"))));
}

}  // namespace curvewright
