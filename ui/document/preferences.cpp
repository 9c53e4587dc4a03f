#include "ui/document/preferences.h"

#include <algorithm>
#include <cmath>

namespace curvewright {

Preferences Preferences::load() {
    const QSettings settings;
    Preferences p;
    const auto read_bool = [&](const char* key, bool& value) {
        const QString text = settings.value(QLatin1String(key)).toString();
        if (text == QLatin1String("true") || text == QLatin1String("1")) value = true;
        if (text == QLatin1String("false") || text == QLatin1String("0")) value = false;
    };
    p.start = read_enum(settings, QStringLiteral("preferences/start"), StartAction::last_mesh, p.start);
    p.mouse = read_enum(settings, QStringLiteral("preferences/mouse"), MouseHabits::blender, p.mouse);
    bool is_number = false;
    if (const int count = settings.value(QStringLiteral("preferences/recent_count")).toInt(&is_number); is_number)
        p.recent_count = std::clamp(count, 0, most_recent);
    if (const int count = settings.value(QStringLiteral("preferences/worst_count")).toInt(&is_number); is_number)
        p.worst_count = std::clamp(count, 1, most_worst);
    read_bool("preferences/keeps_work", p.keeps_work);
    read_bool("preferences/remembers_tool", p.remembers_tool);
    read_bool("preferences/remembers_drawing", p.remembers_drawing);
    read_bool("preferences/starts_with_edges", p.starts_with_edges);
    read_bool("preferences/starts_with_nodes", p.starts_with_nodes);
    read_bool("preferences/starts_with_legend", p.starts_with_legend);
    read_bool("preferences/wheel_is_reversed", p.wheel_is_reversed);
    if (const double percent = settings.value(QStringLiteral("preferences/soft_radius_percent")).toDouble(&is_number);
        is_number && std::isfinite(percent))
        p.soft_radius_percent = std::clamp(percent, 0.1, 100.0);
    return p;
}

void Preferences::store() const {
    QSettings settings;
    settings.setValue(QStringLiteral("preferences/start"), static_cast<int>(start));
    settings.setValue(QStringLiteral("preferences/mouse"), static_cast<int>(mouse));
    settings.setValue(QStringLiteral("preferences/recent_count"), recent_count);
    settings.setValue(QStringLiteral("preferences/keeps_work"), keeps_work);
    settings.setValue(QStringLiteral("preferences/remembers_tool"), remembers_tool);
    settings.setValue(QStringLiteral("preferences/remembers_drawing"), remembers_drawing);
    settings.setValue(QStringLiteral("preferences/starts_with_edges"), starts_with_edges);
    settings.setValue(QStringLiteral("preferences/starts_with_nodes"), starts_with_nodes);
    settings.setValue(QStringLiteral("preferences/starts_with_legend"), starts_with_legend);
    settings.setValue(QStringLiteral("preferences/wheel_is_reversed"), wheel_is_reversed);
    settings.setValue(QStringLiteral("preferences/worst_count"), worst_count);
    settings.setValue(QStringLiteral("preferences/soft_radius_percent"), soft_radius_percent);
}

}  // namespace curvewright
