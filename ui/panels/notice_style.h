#pragma once

#include "ui/document/notice.h"
#include "ui/panels/theme.h"

namespace curvewright {

/// The icon of a kind of notice, in the colour that it has everywhere. Each has a shape of its own, too.
inline QIcon severity_icon(const Theme& theme, NoticeSeverity severity) {
    switch (severity) {
        case NoticeSeverity::information:
            break;
        case NoticeSeverity::warning:
            return theme.icon(QStringLiteral("alert"), QStringLiteral("warning"));
        case NoticeSeverity::error:
            return theme.icon(QStringLiteral("error"), QStringLiteral("alarm"));
    }
    return theme.icon(QStringLiteral("info"), QStringLiteral("accent"));
}

/// What the style sheet calls it.
inline const char* tone_name(NoticeSeverity severity) {
    switch (severity) {
        case NoticeSeverity::information:
            return "information";
        case NoticeSeverity::warning:
            return "warning";
        case NoticeSeverity::error:
            return "error";
    }
    return "";
}

}  // namespace curvewright
