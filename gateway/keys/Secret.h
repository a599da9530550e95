#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace Rabit::Keys
{

// The longest passphrase that OpenSSL reads, in bytes.
inline constexpr std::size_t LongestPassphrase = 1023;

// A passphrase. Its bytes lie in the object alone, and are overwritten when the object ends.
class Secret
{
public:
    // An empty one, which encrypts nothing.
    Secret() = default;
    // Throws KeysError unless it has 1 to LongestPassphrase bytes.
    explicit Secret(std::string_view text);
    ~Secret();
    Secret(const Secret &) = default;
    Secret &operator=(const Secret &) = default;

    std::string_view Text() const { return {_bytes.data(), _size}; }

    // For functions that fill it in place: room for LongestPassphrase bytes and one more. Resize throws as
    // the constructor does.
    char *Room() { return _bytes.data(); }
    void Resize(std::size_t size);

private:
    std::array<char, LongestPassphrase + 1> _bytes{};
    std::size_t _size = 0;
};

}  // namespace Rabit::Keys
