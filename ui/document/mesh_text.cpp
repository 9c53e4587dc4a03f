#include "ui/document/mesh_text.h"

#include <algorithm>
#include <map>
#include <set>

#include <QCollator>
#include <QCoreApplication>
#include <QLocale>
#include <QStringList>

#include "ui/document/core_words.h"
#include "ui/document/number_format.h"

namespace curvewright {
namespace {

QString tr(const char* text, int n = -1) {
    return QCoreApplication::translate("Mesh", text, nullptr, n);
}

std::vector<Index> elements_of_group(const MeshTopology& topology, const PhysicalGroup& group,
                                     const std::vector<Index>& nodes) {
    std::vector<Index> elements;
    if (group.dimension == topology.dimension()) {
        std::set<int> entities;
        for (const Entity& entity : topology.entities())
            if (entity.dimension == group.dimension &&
                std::count(entity.physical_tags.begin(), entity.physical_tags.end(), group.tag) > 0)
                entities.insert(entity.tag);
        for (Index element = 0; element < topology.element_count(); ++element)
            if (entities.contains(topology.element_entity(element))) elements.push_back(element);
    } else if (group.dimension == topology.dimension() - 1) {
        std::vector<bool> in_group(static_cast<std::size_t>(topology.node_count()), false);
        for (Index node : nodes) in_group[static_cast<std::size_t>(node)] = true;
        for (const Facet& facet : topology.boundary_facets()) {
            const auto facet_nodes = topology.facet_nodes(facet);
            const bool is_inside = std::all_of(facet_nodes.begin(), facet_nodes.end(),
                                               [&](Index node) { return in_group[static_cast<std::size_t>(node)]; });
            if (is_inside && (elements.empty() || elements.back() != facet.element)) elements.push_back(facet.element);
        }
    }
    return elements;
}

}  // namespace

QString describe_elements(const MeshTopology& topology) {
    std::map<ElementType, long> counts;
    for (const ElementBlock& block : topology.blocks())
        if (dimension(block.type.shape) == topology.dimension()) counts[block.type] += block.size();
    QStringList parts;
    for (const auto& [type, count] : counts) {
        parts << QStringLiteral("P%1 · %2 %3").arg(type.order).arg(format_count(count), shape_name(type.shape, count));
    }
    return parts.isEmpty() ? tr("no elements") : parts.join(QStringLiteral(", "));
}

QString describe_validity(const QualitySummary& summary) {
    QStringList parts;
    if (summary.invalid == 0 && summary.undecided == 0)
        parts << (summary.not_assessed == 0 ? tr("✓ all proved valid")
                                            : tr("✓ %1 proved valid").arg(format_count(summary.valid)));
    if (summary.invalid > 0) parts << tr("✕ %1 tangled").arg(format_count(summary.invalid));
    if (summary.undecided > 0) parts << tr("? %1 undecided").arg(format_count(summary.undecided));
    if (summary.not_assessed > 0) parts << tr("%1 not assessed").arg(format_count(summary.not_assessed));
    if (summary.reversed > 0) parts << tr("%1 reversed").arg(format_count(summary.reversed));
    return parts.join(QStringLiteral(" · "));
}

QString validity_sentence(const QualitySummary& summary) {
    if (summary.invalid == 0 && summary.undecided == 0)
        return summary.not_assessed == 0 ? tr("✓ all proved valid")
                                         : tr("✓ %1 proved valid, %2 pyramids not assessed")
                                               .arg(format_count(summary.valid), format_count(summary.not_assessed));
    QString text;
    if (summary.invalid == 1) text = tr("✕ 1 element is tangled (scaled Jacobian ≤ 0)");
    if (summary.invalid > 1)
        text = tr("✕ %1 elements are tangled (scaled Jacobian ≤ 0)").arg(format_count(summary.invalid));
    if (summary.undecided > 0) {
        const QString undecided = tr("%1 undecided").arg(format_count(summary.undecided));
        text = text.isEmpty() ? QStringLiteral("? ") + undecided : text + QStringLiteral(", ") + undecided;
    }
    return text;
}

QVector<GroupLine> list_groups(const MeshTopology& topology) {
    QVector<GroupLine> lines;
    for (const PhysicalGroup& group : topology.groups()) {
        const std::string name = MeshTopology::display_name(group);
        auto nodes = topology.find_group_nodes(name).value_or(std::vector<Index>());
        std::vector<Index> elements = elements_of_group(topology, group, nodes);
        lines.push_back({QString::fromStdString(name), group.dimension, std::move(nodes), std::move(elements)});
    }
    // Not the locale of the environment: that of C does not know numbers.
    QCollator collator(QLocale(QLocale::English, QLocale::UnitedStates));
    collator.setNumericMode(true);  // hole2 before hole10
    std::stable_sort(lines.begin(), lines.end(), [&collator](const GroupLine& a, const GroupLine& b) {
        return a.dimension > b.dimension || (a.dimension == b.dimension && collator.compare(a.name, b.name) < 0);
    });
    return lines;
}

}  // namespace curvewright
