#include <random>

#include "core/io/atomic_file.h"
#include "core/io/msh_io.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

const std::string head_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";                                // lines 1-3
const std::string head_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";                                // lines 1-3
const std::string nodes_41 = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";  // lines 4-13
const std::string nodes_22 = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";                    // lines 4-9

struct Broken {
    const char* what;
    std::string text;
    std::string expected;  ///< part of the message
};

TEST(HostileMsh, bad_input_is_told_with_line_and_reason) {
    const std::vector<Broken> table = {
        {"no sections", "hello\n", "bad.msh:1: the file does not begin with $MeshFormat"},
        {"blank", " \n\n", "bad.msh: the file is empty"},
        {"section before the format", "$Nodes\n", "bad.msh:1: $Nodes stands before $MeshFormat"},
        {"end without begin", head_41 + "$EndNodes\n", "bad.msh:4: $EndNodes closes"},
        {"format cut", "$MeshFormat\n4.1", "bad.msh:2: the file ends where the file type"},
        {"format twice", head_41 + head_41, "bad.msh:4: a second $MeshFormat"},
        {"wrong end", "$MeshFormat\n4.1 0 8\n$EndNodes\n", "bad.msh:3: \"$EndNodes\" stands where $EndMeshFormat"},
        {"no nodes", head_41, "bad.msh: the file ends without a $Nodes section"},
        {"no elements", head_41 + nodes_41, "bad.msh: the file ends without an $Elements section"},
        {"elements first", head_41 + "$Elements\n0 0 0 0\n$EndElements\n", "bad.msh:4: $Elements stands before $Nodes"},
        {"nodes twice", head_41 + nodes_41 + nodes_41, "bad.msh:14: a second $Nodes"},
        {"negative count", head_41 + "$Nodes\n-1 3 1 3\n", "bad.msh:5: the number of node blocks is -1"},
        {"huge count", head_41 + "$Nodes\n1 99999999999 1 3\n", "99999999999 nodes are announced, but the file ends"},
        {"count beyond all", head_41 + "$Nodes\n1 99999999999999999999 1 3\n", "bad.msh:5: \"99999999999999999999\""},
        {"huge count, 2.2", head_22 + "$Nodes\n4000000000\n", "4000000000 nodes are announced"},
        {"count is a word", head_22 + "$Nodes\nmany\n", "bad.msh:5: \"many\" stands where the number of nodes"},
        {"count has a fraction", head_22 + "$Nodes\n3.0\n", "\"3.0\" stands where"},
        {"coordinate is a word", head_22 + "$Nodes\n1\n1 0 zero 0\n", "bad.msh:6: \"zero\" stands where a coordinate"},
        {"coordinate nan", head_22 + "$Nodes\n1\n1 0 nan 0\n$EndNodes\n", "bad.msh:6: \"nan\""},
        {"coordinate inf", head_22 + "$Nodes\n1\n1 0 -inf 0\n$EndNodes\n", "finite number"},
        {"coordinate too large", head_22 + "$Nodes\n1\n1 0 1e999 0\n$EndNodes\n", "\"1e999\""},
        {"node twice", head_22 + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n", "bad.msh:7: node 1 occurs twice"},
        {"negative node", head_22 + "$Nodes\n1\n-4 0 0 0\n$EndNodes\n", "bad.msh:6: a node has the tag -4"},
        {"more nodes than told", head_41 + "$Nodes\n1 1 1 3\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n",
         "bad.msh:6: the blocks hold more nodes"},
        {"fewer nodes than told", head_41 + "$Nodes\n1 2 1 3\n2 1 0 1\n1\n0 0 0\n$EndNodes\n", "hold 1 nodes, but 2"},
        {"node dimension", head_41 + "$Nodes\n1 1 1 1\n4 1 0 1\n1\n0 0 0\n$EndNodes\n", "has dimension 4"},
        {"parametric flag", head_41 + "$Nodes\n1 1 1 1\n2 1 7 1\n1\n0 0 0\n$EndNodes\n", "7 stands where 0 or 1"},
        {"dangling node", head_41 + nodes_41 + "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 8\n$EndElements\n",
         "bad.msh:17: element 1 refers to node 8, which does not exist"},
        {"dangling node, 2.2", head_22 + nodes_22 + "$Elements\n1\n1 2 0 1 2 8\n$EndElements\n",
         "bad.msh:12: element 1 refers to node 8"},
        {"node twice in an element", head_22 + nodes_22 + "$Elements\n1\n1 2 0 1 2 2\n$EndElements\n",
         "bad.msh: Element 1 has node 2 twice"},
        {"element twice", head_41 + nodes_41 + "$Elements\n1 2 1 1\n2 1 2 2\n1 1 2 3\n1 1 2 3\n$EndElements\n",
         "bad.msh:18: element 1 occurs twice"},
        {"element twice, 2.2", head_22 + nodes_22 + "$Elements\n2\n1 2 2 5 1 1 2 3\n1 2 2 5 1 1 2 3\n$EndElements\n",
         "bad.msh:13: element 1 occurs twice"},
        {"other element of the same tag",
         head_22 + nodes_22 + "$Elements\n2\n1 2 2 5 1 1 2 3\n1 2 2 6 1 1 3 2\n$EndElements\n",
         "bad.msh:13: element 1 occurs twice"},
        {"element of the wrong dimension", head_41 + nodes_41 + "$Elements\n1 1 1 1\n1 1 2 1\n1 1 2 3\n$EndElements\n",
         "bad.msh:16: a triangle cannot lie on an entity of dimension 1"},
        {"more elements than told", head_41 + nodes_41 + "$Elements\n1 0 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
         "more elements than the 0"},
        {"huge block", head_41 + nodes_41 + "$Elements\n1 1 1 1\n2 1 2 777777777\n1 1 2 3\n$EndElements\n",
         "777777777"},
        {"element too short", head_22 + nodes_22 + "$Elements\n1\n1 2 0 1 2\n$EndElements\n",
         "\"$EndElements\" stands where a node of an element"},
        {"unending section", head_41 + "$Thing\n1\n", "bad.msh:4: section $Thing has no $EndThing"},
        {"entity twice", head_41 + "$Entities\n2 0 0 0\n1 0 0 0 0\n1 0 0 0 0\n$EndEntities\n",
         "bad.msh:7: entity 1 of dimension 0 occurs twice"},
        {"huge number of groups of an entity", head_41 + "$Entities\n1 0 0 0\n1 0 0 0 123456789\n$EndEntities\n",
         "123456789 physical tags"},
        {"name without quotes", head_41 + "$PhysicalNames\n1\n2 1 domain\n$EndPhysicalNames\n",
         "bad.msh:6: the name of a physical group in quotation marks"},
        {"name dimension", head_41 + "$PhysicalNames\n1\n5 1 \"a\"\n$EndPhysicalNames\n", "has dimension 5"},
    };
    const TemporaryFolder folder;
    for (const Broken& broken : table) {
        const auto file = folder.write("bad.msh", broken.text);
        const std::string message = message_of<InvalidInput>([&] { read_mesh(file); });
        EXPECT_NE(message.find(broken.expected), std::string::npos)
            << broken.what << "\n  expected: " << broken.expected << "\n  message:  " << message;
    }
}

TEST(HostileMsh, what_is_not_supported_is_told_by_name) {
    const std::vector<Broken> table = {
        {"binary", std::string("$MeshFormat\n4.1 1 8\n\1\0\0\0", 24), "gmsh FILE -save -format msh41"},
        {"version 1", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "MSH version 1"},
        {"version 3", "$MeshFormat\n3 0 8\n$EndMeshFormat\n", "MSH version 3 is not supported"},
        {"version 5", "$MeshFormat\n5.0 0 8\n$EndMeshFormat\n", "MSH version 5"},
        {"serendipity", head_22 + nodes_22 + "$Elements\n1\n42 16 0 1 2 3 1 2 3 1 2\n$EndElements\n",
         "bad.msh:12: element 42 is of Gmsh type 16"},
        {"incomplete triangle",
         head_41 + nodes_41 + "$Elements\n1 1 1 1\n2 6 20 1\n1 1 2 3 1 2 3 1 2 3\n$EndElements\n",
         "bad.msh:16: the elements on entity 6 of dimension 2 are of Gmsh type 20"},
        {"unknown type", head_22 + nodes_22 + "$Elements\n1\n42 -7 0 1\n$EndElements\n", "Gmsh type -7"},
    };
    const TemporaryFolder folder;
    for (const Broken& broken : table) {
        const auto file = folder.write("bad.msh", broken.text);
        const std::string message = message_of<Unsupported>([&] { read_mesh(file); });
        EXPECT_NE(message.find(broken.expected), std::string::npos) << broken.what << ": " << message;
    }
}

TEST(HostileMsh, files_cut_at_any_line_are_refused) {
    for (const char* name : {"annulus.msh", "annulus_2.2.msh", "square_partitioned.msh", "square_4.0.msh"}) {
        const std::string text = read_text_file(test_data(name));
        const std::size_t last_line = text.rfind("$EndElements");
        for (std::size_t end = text.find('\n'); end < last_line; end = text.find('\n', end + 1))
            EXPECT_THROW(read_msh(text.substr(0, end), name, {}), InvalidInput) << name << " cut at " << end;
    }
}

TEST(HostileMsh, random_damage_never_crashes) {
    std::mt19937 random(20240117);
    int refused = 0, read = 0;
    const std::string alphabet = "0123456789-+.e $\n\"EndN\0x\xff";
    for (const char* name : {"square_2.2.msh", "square_4.0.msh", "square_partitioned.msh", "annulus.msh"}) {
        const std::string text = read_text_file(test_data(name));
        for (int round = 0; round < 1500; ++round) {
            std::string damaged = text;
            for (unsigned i = 0, count = 1 + random() % 4; i < count; ++i)
                damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
            try {
                read_msh(damaged, name, {});
                ++read;
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 1000);
    EXPECT_GT(read, 100);  // a digit of a coordinate is a change, not an error
}

}  // namespace
}  // namespace curvewright
