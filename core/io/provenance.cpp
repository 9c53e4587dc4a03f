#include "core/io/provenance.h"

#include <initializer_list>
#include <utility>

namespace curvewright {

std::string provenance_text(const Provenance& provenance) {
    const std::string program =
        provenance.version.empty() ? provenance.program : provenance.program + " " + provenance.version;
    std::string text;
    for (const auto& [key, value] : std::initializer_list<std::pair<const char*, const std::string&>>{
             {"Made by", program},
             {"Command", provenance.command},
             {"Input", provenance.input},
             {"Input SHA-256", provenance.input_sha256}}) {
        if (value.empty()) continue;
        text += key;
        text += ": ";
        for (const char c : value) {
            const auto code = static_cast<unsigned char>(c);
            text += code < 32 || code == 127 ? ' ' : c;
        }
        text += '\n';
    }
    return text;
}

}  // namespace curvewright
