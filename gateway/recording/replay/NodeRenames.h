#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Replay
{

// The names of recorded nodes in a replay. The first rule `FROM=TO` that fits holds. Without one the name
// gets a prefix, so that replayed nodes are not taken for nodes that fly. `*` in FROM stands for any
// characters, which `*` in TO repeats: `*=*` keeps all names.
class NodeRenames
{
public:
    static constexpr std::string_view Prefix = "replay.";

    // Adds a rule. Returns an empty text, or why the text is no rule.
    std::string Add(std::string_view rule);
    // Returns the new name. It may be too long to be valid.
    std::string NewNameOf(const std::string &node) const;
    // Applies the rules alone: for nodes that are not played, but get messages.
    std::string RuledNameOf(const std::string &node) const;

private:
    struct Rule
    {
        std::string From;
        std::string To;
    };
    const Rule *Find(const std::string &node) const;
    static std::string Apply(const Rule &rule, const std::string &node);

    std::vector<Rule> _rules;
};

}  // namespace Rabit::Replay
