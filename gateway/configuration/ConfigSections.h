#pragma once

#include <string>
#include <vector>

namespace Rabit
{

// One key that a mapping of a configuration file may have. All texts are for people; the manual shows them.
struct ConfigKey
{
    std::string Name;
    std::string Value;    // what may stand there, with the range: "number from 0.01 to 100"
    std::string Default;  // as the file would say it; empty: none
    std::string Example;  // as the file would say it
    std::string Help;
    bool IsRequired = false;
};

// One mapping of a configuration file.
struct ConfigSection
{
    std::string Path;   // the keys that lead to it, as `record.black_box`; empty: the whole file
    std::string Title;  // as errors name it: "a `publish` entry"
    std::string Help;
    std::vector<ConfigKey> Keys;

    std::vector<std::string> Names() const;
};

// All sections with all keys that a configuration file may have, in the order of the manual. The loader
// refuses other keys, and the manual's reference is made from this table.
const std::vector<ConfigSection> &ConfigSections();

// Throws std::out_of_range if there is none.
const ConfigSection &ConfigSectionAt(const std::string &path);

}  // namespace Rabit
