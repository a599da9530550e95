#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace Rabit
{

// The IDL texts of the types of this process (MessageTypeRegistry), by their definition hashes. Not
// thread-safe.
class KnownTexts
{
public:
    // Returns null if no type has that hash. The text stays valid as long as the process.
    const std::string *Find(std::uint64_t definition);

private:
    std::map<std::uint64_t, const std::string *> _texts;
    std::size_t _types = 0;  // that were looked at
};

}  // namespace Rabit
