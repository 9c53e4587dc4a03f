#include "ui/document/notice_board.h"

#include <algorithm>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

/// Parts of either orientation in the file are numbered so; later on they are tangled.
bool is_mixed(const MeshState& state) {
    return state.quality && state.quality->orientation == Orientation::mixed;
}

bool is_negative(const MeshState& state) {
    return state.quality && state.quality->orientation == Orientation::negative;
}

}  // namespace

std::vector<Notice> standing_notices(const MeshDocument& document) {
    std::vector<Notice> notices;
    const MeshState& state = document.state();
    if (!state.mesh) return notices;
    if (!state.quality) {
        notices.push_back(
            {NoticeSeverity::warning, state.quality_note, {}, NoticeLife::document, QStringLiteral("quality")});
        return notices;
    }
    const Orientation orientation = state.quality->orientation;
    // What was turned over by what has been done since is tangled, not numbered so.
    if (orientation == Orientation::negative && is_negative(document.original()))
        notices.push_back(
            {NoticeSeverity::warning,
             NoticeBoard::tr("All elements are numbered clockwise, so their Jacobian is negative. That is a matter of "
                             "numbering, not of tangling."),
             {{NoticeCommand::flip}},
             NoticeLife::state,
             QStringLiteral("orientation")});
    else if (orientation == Orientation::mixed && is_mixed(document.original()))
        notices.push_back(
            {NoticeSeverity::information,
             NoticeBoard::tr("Some parts of the mesh are numbered clockwise and others counter-clockwise; "
                             "each is judged by its own numbering."),
             {{NoticeCommand::renumber}},
             NoticeLife::state,
             QStringLiteral("orientation")});
    if (const Index count = state.quality->summary.reversed; count > 0) {
        std::vector<Index> reversed;
        for (std::size_t i = 0; i < state.quality->elements.size(); ++i)
            if (state.quality->elements[i].is_reversed) reversed.push_back(static_cast<Index>(i));
        const QString text =
            count == 1 ? NoticeBoard::tr("1 element is numbered against its neighbours.")
                       : NoticeBoard::tr("%1 elements are numbered against their neighbours.").arg(format_count(count));
        notices.push_back({NoticeSeverity::warning,
                           text + QLatin1Char(' ') + NoticeBoard::tr("That is a matter of numbering, not of tangling."),
                           {{NoticeCommand::renumber}, selecting_elements(std::move(reversed))},
                           NoticeLife::state,
                           QStringLiteral("reversed")});
    }
    return notices;
}

NoticeBoard::NoticeBoard(const MeshDocument& document, QObject* parent) : QObject(parent), document_(document) {
    connect(&document, &MeshDocument::opened, this, [this] {
        entries_.clear();
        follow_document();
    });
    connect(&document, &MeshDocument::state_changed, this, &NoticeBoard::follow_document);
}

const Notice* NoticeBoard::find(int id) const {
    const auto line = std::find_if(lines_.begin(), lines_.end(), [id](const Line& its) { return its.id == id; });
    return line == lines_.end() ? nullptr : &line->notice;
}

void NoticeBoard::post(Notice notice) {
    const auto& about = document_.state().mesh;
    std::erase_if(entries_, [&](const Entry& entry) {
        if (entry.is_standing) return false;
        const Notice& its = entry.line.notice;
        const bool is_same = notice.topic.isEmpty() ? its.text == notice.text : its.topic == notice.topic;
        return is_same && entry.about.lock() == about;
    });
    entries_.push_back({{++last_id_, std::move(notice)}, about});
    refresh();
}

void NoticeBoard::dismiss(int id) {
    for (Entry& entry : entries_)
        if (entry.line.id == id) entry.is_dismissed = true;
    refresh();
}

bool NoticeBoard::is_alive(const Entry& entry) const {
    const auto about = entry.about.lock();
    switch (entry.line.notice.life) {
        case NoticeLife::document:
            return true;
        case NoticeLife::state:
            return about == document_.state().mesh;
        case NoticeLife::step:
            for (int step = 0; step <= document_.history()->index(); ++step)
                if (document_.state_at(step).mesh == about) return true;
            return false;
    }
    return false;
}

/// The standing notices of a state are made anew, but keep their number and what was done with them where they say the
/// same again.
void NoticeBoard::follow_document() {
    // What was about a state that is gone from the history.
    std::erase_if(entries_, [this](const Entry& entry) {
        return entry.line.notice.life != NoticeLife::document && document_.has_mesh() && entry.about.expired();
    });
    const std::vector<Notice> standing = standing_notices(document_);
    std::erase_if(entries_, [&](const Entry& entry) {
        return entry.is_standing && !entry.is_dismissed &&
               std::none_of(standing.begin(), standing.end(),
                            [&](const Notice& notice) { return notice.text == entry.line.notice.text; });
    });
    for (const Notice& notice : standing) {
        const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
            return entry.is_standing && entry.line.notice.text == notice.text;
        });
        if (known == entries_.end()) {
            Entry entry{{++last_id_, notice}, document_.state().mesh};
            entry.is_standing = true;
            entries_.push_back(std::move(entry));
        } else {
            known->line.notice = notice;
            known->about = document_.state().mesh;
        }
    }
    refresh();
}

void NoticeBoard::refresh() {
    std::vector<Line> lines;
    for (const Entry& entry : entries_)
        if (!entry.is_dismissed && is_alive(entry)) lines.push_back(entry.line);
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
        if (a.notice.severity != b.notice.severity) return a.notice.severity > b.notice.severity;
        return a.id > b.id;
    });
    const auto is_same = [](const Line& a, const Line& b) {
        return a.id == b.id && a.notice.text == b.notice.text && a.notice.actions.size() == b.notice.actions.size();
    };
    const bool are_same = std::equal(lines.begin(), lines.end(), lines_.begin(), lines_.end(), is_same);
    lines_ = std::move(lines);
    if (!are_same) emit changed();
}

}  // namespace curvewright
