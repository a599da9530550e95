#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Replay
{

// What the nodes of a recording are called when it is played: by rules `FROM=TO`, of which the first that
// fits holds, else by a prefix, so that they are not taken for those that fly. `*` in FROM stands for any
// characters, which `*` in TO repeats: `*=*` leaves all names as they were.
class NodeRenames
{
public:
    static constexpr std::string_view Prefix = "replay.";

    // Takes a rule in. Returns an empty text, or why it is none.
    std::string Add(std::string_view rule);
    // May be no valid name, if the old one is long.
    std::string NewNameOf(const std::string &node) const;
    // By the rules alone: for nodes to which something is sent, and which are not played.
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
