#include "ui/document/mesh_text.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <QCollator>
#include <QCoreApplication>
#include <QLocale>
#include <QStringList>

#include "core/boundary/boundary_rules.h"
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
        const auto is_in_group = [&](const Facet& facet) {
            const auto facet_nodes = topology.facet_nodes(facet);
            return std::all_of(facet_nodes.begin(), facet_nodes.end(),
                               [&](Index node) { return in_group[static_cast<std::size_t>(node)]; });
        };
        for (const Facet& facet : topology.boundary_facets())
            if (is_in_group(facet)) elements.push_back(facet.element);
        // Of an interface those on both sides.
        const std::vector<Facet>& interfaces = topology.interface_facets();
        for (std::size_t i = 0; i < interfaces.size(); ++i)
            if (is_in_group(interfaces[i]))
                elements.insert(elements.end(), {interfaces[i].element, topology.interface_neighbours()[i]});
        std::sort(elements.begin(), elements.end());
        elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    }
    return elements;
}

/// What lies between regions without a group of its own, under the name that boundary rules have for it; none if there
/// is nothing of the kind, or if a group has this name.
std::optional<GroupLine> unnamed_interfaces(const MeshTopology& topology) {
    GroupLine line{QString::fromLatin1(all_interfaces_name), topology.dimension() - 1, {}, {}};
    for (const PhysicalGroup& group : topology.groups())
        if (MeshTopology::display_name(group) == all_interfaces_name) return std::nullopt;
    std::vector<bool> is_unnamed(static_cast<std::size_t>(topology.node_count()), false);
    for (const auto& [node, names] : names_of_interface_nodes(topology))
        if (names.contains(all_interfaces_name)) {
            line.nodes.push_back(node);
            is_unnamed[static_cast<std::size_t>(node)] = true;
        }
    if (line.nodes.empty()) return std::nullopt;
    const std::vector<Facet>& facets = topology.interface_facets();
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const auto nodes = topology.facet_nodes(facets[i]);
        if (std::none_of(nodes.begin(), nodes.end(),
                         [&](Index node) { return is_unnamed[static_cast<std::size_t>(node)]; }))
            continue;
        line.elements.insert(line.elements.end(), {facets[i].element, topology.interface_neighbours()[i]});
        line.nodes.insert(line.nodes.end(), nodes.begin(), nodes.end());  // where it ends on the boundary, too
    }
    for (std::vector<Index>* its : {&line.nodes, &line.elements}) {
        std::sort(its->begin(), its->end());
        its->erase(std::unique(its->begin(), its->end()), its->end());
    }
    return line;
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
    if (const auto interfaces = unnamed_interfaces(topology)) lines.push_back(*interfaces);
    // Not the locale of the environment: that of C does not know numbers.
    QCollator collator(QLocale(QLocale::English, QLocale::UnitedStates));
    collator.setNumericMode(true);  // hole2 before hole10
    std::stable_sort(lines.begin(), lines.end(), [&collator](const GroupLine& a, const GroupLine& b) {
        return a.dimension > b.dimension || (a.dimension == b.dimension && collator.compare(a.name, b.name) < 0);
    });
    return lines;
}

}  // namespace curvewright
