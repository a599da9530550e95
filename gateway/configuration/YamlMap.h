#pragma once

#include <rabit/gateway/ByteSize.h>

#include <yaml-cpp/yaml.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "configuration/ConfigSections.h"

namespace Rabit
{

// One mapping of a YAML file. Errors (ConfigError) name the file, the line and the expected value. A
// missing key leaves its value unchanged, so that defaults stand in one place: the structure that is
// filled.
class YamlMap
{
public:
    // Refuses anything but a mapping, keys that are not in the section, a key used twice, and a mapping
    // without a required key.
    YamlMap(std::string file, const YAML::Node &node, const ConfigSection &section);

    // The same with any keys. `what` names the mapping in messages.
    YamlMap(std::string file, const YAML::Node &node, std::string what);

    bool Has(const std::string &key) const;
    // In the order of the file.
    std::vector<std::string> Keys() const;
    // Returns the line, from 1, of the key's value, or of the whole mapping if there is no such key.
    int Line(const std::string &key = "") const;
    // The line of each key.
    std::map<std::string, int> Lines() const;
    void Require(const std::string &key) const;

    void Read(const std::string &key, std::string &value) const;
    void Read(const std::string &key, bool &value) const;
    void Read(const std::string &key, double &value) const;
    void Read(const std::string &key, int &value, int least, int most) const;
    void Read(const std::string &key, std::size_t &value, std::size_t least, std::size_t most) const;
    // `5s`, `200ms`, `2min`; a bare number is refused because its unit would be a guess.
    void Read(const std::string &key, std::chrono::milliseconds &value) const;
    // Bytes a second: `1500B/s`, `5kB/s`, `2MB/s` (of 1000 and 1000000 bytes), or `auto` for an empty value.
    void ReadByteRate(const std::string &key, std::optional<double> &value) const;
    void ReadByteSize(const std::string &key, std::uint64_t &value, const ByteRange &range) const;
    // Reads a list of words, or one word alone.
    void Read(const std::string &key, std::vector<std::string> &value) const;
    // Reads one of the words. Returns its index, or -1 if the key is missing.
    int ReadChoice(const std::string &key, const std::vector<std::string> &choices) const;
    // Reads an enumeration, perhaps into an optional; the index of a word is its value.
    template <typename Value, typename Enumeration = Value>
    void Read(const std::string &key, const std::vector<std::string> &words, Value &value) const
    {
        if (const int choice = ReadChoice(key, words); choice >= 0)
        {
            value = static_cast<Enumeration>(choice);
        }
    }
    // Read names of IDL types. A leading `::`, which IDL allows, is left out.
    void ReadType(const std::string &key, std::string &value) const;
    void ReadTypes(const std::string &key, std::vector<std::string> &value) const;
    // A mapping; empty if the key is missing.
    std::optional<YamlMap> Map(const std::string &key, const ConfigSection &section) const;
    std::optional<YamlMap> MapOfAnyKeys(const std::string &key, const std::string &what) const;
    // A list of mappings; empty if the key is missing.
    std::vector<YamlMap> Maps(const std::string &key, const ConfigSection &section) const;

    [[noreturn]] void Fail(int line, const std::string &message) const;

private:
    // A null pointer allows any key.
    YamlMap(std::string file, const YAML::Node &node, std::string what, const ConfigSection *section);
    const YAML::Node *Find(const std::string &key) const;
    template <typename Number>
    void ReadWhole(const std::string &key, Number &value, Number least, Number most) const;
    const std::string &Scalar(const YAML::Node &node, const std::string &key, const char *expected) const;

    std::string _file;
    std::string _what;
    int _line = 0;
    std::vector<std::pair<std::string, YAML::Node>> _entries;
};

}  // namespace Rabit
