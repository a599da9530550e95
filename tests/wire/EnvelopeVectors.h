// Sealed datagrams with all that made them, as lines of a name and hexadecimal digits. envelope_vectors.txt
// holds them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "Hex.h"
#include "transport/envelope/SealNodes.h"

namespace Rabit::Test
{

using EnvelopeVectors = std::map<std::string, std::vector<std::uint8_t>>;

inline std::string LinesOf(const EnvelopeVectors &vectors)
{
    std::string text;
    for (const auto &[name, bytes] : vectors)
    {
        std::string digits = HexOf(bytes);
        std::erase(digits, '\n');
        text += name + " " + digits + "\n";
    }
    return text;
}

inline EnvelopeVectors ReadVectors(std::istream &lines)
{
    EnvelopeVectors vectors;
    for (std::string line; std::getline(lines, line);)
    {
        const std::size_t space = line.find(' ');
        if (space == std::string::npos)
        {
            throw std::runtime_error("not a name and digits: " + line);
        }
        vectors[line.substr(0, space)] = BytesOf(line.substr(space + 1));
    }
    return vectors;
}

// Datagrams that the node A seals for all and for B.
inline EnvelopeVectors MakeEnvelopeVectors()
{
    using namespace SealNodes;
    const auto bytesOf = [](const auto &array) { return Bytes(array.begin(), array.end()); };
    Authority authority;
    // Numbers that need more than 32 bits.
    Node a(authority, "uav1", 1, 0, (std::uint64_t{5} << 32) + 1000);
    Node b(authority, "ground", 2);
    a.Meet(b);
    const AgreementKey once = *AgreementKey::Of(SeedOf(5, 0));
    EnvelopeVectors vectors = {{"authority", bytesOf(authority.Signing.Public())},
                               {"epoch", {1, 0}},
                               {"secret", bytesOf(FirstSecret.Bytes())},
                               {"next_secret", bytesOf(SecondSecret.Bytes())},
                               {"b_nonce", bytesOf(b.NonceOf())},
                               {"message", a.Message(40)},
                               {"message_of_second_header", MessageOf(a.Me.Headers[1], 24)}};
    const auto addNode = [&](const std::string &prefix, const Node &node, std::uint8_t number)
    {
        vectors[prefix + "signing"] = bytesOf(SeedOf(3, number).Bytes());
        vectors[prefix + "agreement"] = bytesOf(SeedOf(4, number).Bytes());
        vectors[prefix + "session"] = bytesOf(node.Me.Own.Session);
        vectors[prefix + "certificate"] = node.Me.Certificate;
        vectors[prefix + "header0"] = bytesOf(node.Me.Headers[0]);
        vectors[prefix + "header1"] = bytesOf(node.Me.Headers[1]);
    };
    addNode("a_", a, 1);
    addNode("b_", b, 2);
    vectors["claim"] = a.Claims({b.NonceOf()});
    vectors["group"] = a.ToAll(vectors["message"]);
    vectors["pairwise"] = a.Pairwise(vectors["message"], b, OuterClass::Meeting);
    vectors["group_of_second_header"] = a.ToAll(vectors["message_of_second_header"], OuterClass::Bulletin);
    vectors["bulletin"] = Bulletin::Write(2, {9, 3},
                                          {{.Number = 1, .Agreement = a.Me.Agreement.Public()},
                                           {.Number = 2, .Agreement = b.Me.Agreement.Public()}},
                                          SecondSecret, once, authority.Signing);
    return vectors;
}

// Opens at B what vectors of these names hold, all but the claim in front of it. Returns what is wrong, or
// nothing.
inline std::string WrongAtB(const EnvelopeVectors &vectors)
{
    using namespace SealNodes;
    Authority authority;
    Node b(authority, "ground", 2);
    if (b.Opens.Open(vectors.at("claim"), Start).Verdict != ClaimVerdict::Proven)
    {
        return "the claim is not proven";
    }
    const std::vector<std::pair<std::string, std::string>> all = {
        {"group", "message"},
        {"pairwise", "message"},
        {"group_of_second_header", "message_of_second_header"}};
    for (const auto &[name, message] : all)
    {
        const Opener::Result result = b.Opens.Open(vectors.at(name), Start);
        if (result.Fault != OpenFault::None || SealNodes::BytesOf(result.Message) != vectors.at(message))
        {
            return name + " does not open: fault " + std::to_string(static_cast<int>(result.Fault));
        }
    }
    return {};
}

}  // namespace Rabit::Test
