#include "ui/document/tag_query.h"

#include <algorithm>

#include <QCoreApplication>
#include <QRegularExpression>
#include <QStringList>

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("TagQuery", text);
}

constexpr qsizetype most_named = 5;  ///< missing tags that are told one by one

/// "There is no node 52.", "There are no nodes 52 and 60-70."
QString missing_sentence(const QStringList& tags, const QString& one, const QString& several) {
    if (tags.isEmpty()) return {};
    if (tags.size() == 1 && !tags.front().contains(QChar(0x2013))) return one.arg(tags.front());
    QStringList named = tags.mid(0, most_named);
    if (tags.size() > most_named) named << tr("%1 more").arg(tags.size() - most_named);
    if (named.size() == 1) return several.arg(named.front());
    const QString last = named.takeLast();
    return several.arg(tr("%1 and %2").arg(named.join(QStringLiteral(", ")), last));
}

}  // namespace

TagQuery find_tags(const MeshTopology& topology, const QString& text) {
    static const QRegularExpression blanks_of_range(QStringLiteral("\\s*[-\\x{2013}]\\s*"));
    static const QRegularExpression separators(QStringLiteral("[,;\\s]+"));
    static const QRegularExpression item(QStringLiteral("^([neNE]?)(\\d{1,18})(?:-[neNE]?(\\d{1,18}))?$"));
    TagQuery query;
    QStringList missing_nodes, missing_elements;
    QString whole = text;
    whole.replace(blanks_of_range, QStringLiteral("-"));
    // "e 7" is "e7".
    static const QRegularExpression loose_letter(QStringLiteral("\\b([neNE])\\s+(?=\\d)"));
    whole.replace(loose_letter, QStringLiteral("\\1"));
    for (const QString& word : whole.split(separators, Qt::SkipEmptyParts)) {
        const QRegularExpressionMatch match = item.match(word);
        if (!match.hasMatch()) {
            query.problem = tr("“%1” is no tag: write 12, 40-52 for nodes and e7 for an element.").arg(word);
            return query;
        }
        const bool is_element = match.captured(1).compare(QLatin1String("e"), Qt::CaseInsensitive) == 0;
        const long long first = match.captured(2).toLongLong();
        const bool is_range = !match.captured(3).isEmpty();
        const long long last = is_range ? match.captured(3).toLongLong() : first;
        IndexSet& found = is_element ? query.elements : query.nodes;
        const std::size_t before = found.size();
        if (!is_range) {
            const auto index =
                is_element ? topology.find_element(ElementTag{first}) : topology.find_node(NodeTag{first});
            if (index) found.push_back(*index);
        } else {
            const auto [low, high] = std::minmax(first, last);
            const Index count = is_element ? topology.element_count() : topology.node_count();
            for (Index i = 0; i < count; ++i) {
                const auto tag =
                    static_cast<long long>(is_element ? topology.element_tag(i).value : topology.node_tag(i).value);
                if (tag >= low && tag <= high) found.push_back(i);
            }
        }
        if (found.size() == before) {
            const QString named = is_range ? QStringLiteral("%1\u2013%2").arg(first).arg(last) : QString::number(first);
            (is_element ? missing_elements : missing_nodes) << named;
        }
    }
    for (IndexSet* set : {&query.nodes, &query.elements}) {
        std::sort(set->begin(), set->end());
        set->erase(std::unique(set->begin(), set->end()), set->end());
    }
    const QString nodes = missing_sentence(missing_nodes, tr("There is no node %1."), tr("There are no nodes %1."));
    const QString elements =
        missing_sentence(missing_elements, tr("There is no element %1."), tr("There are no elements %1."));
    query.problem = nodes.isEmpty() || elements.isEmpty() ? nodes + elements : nodes + QLatin1Char(' ') + elements;
    return query;
}

}  // namespace curvewright
