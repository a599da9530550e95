#pragma once

#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Rabit
{

// The numbers of the types on one link. Each name is sent until the receiver has it.
class TypeNumbers
{
public:
    // `type` must live as long as the object. LinkMaxTypes: there are no more numbers.
    std::uint32_t NumberOf(const std::string &type)
    {
        for (std::size_t i = 0; i < _types.size(); ++i)
        {
            if (_types[i].Name == &type)
            {
                return static_cast<std::uint32_t>(i);
            }
        }
        if (_types.size() >= LinkMaxTypes)
        {
            return LinkMaxTypes;
        }
        _types.push_back({&type, false});
        return static_cast<std::uint32_t>(_types.size() - 1);
    }
    bool IsKnown(std::uint32_t number) const { return number < _types.size() && _types[number].IsKnown; }
    void SetKnown(std::uint32_t number)
    {
        if (number < _types.size())
        {
            _types[number].IsKnown = true;
        }
    }
    // A new incarnation of the receiver knows no numbers.
    void ForgetKnown()
    {
        for (Type &type : _types)
        {
            type.IsKnown = false;
        }
    }

private:
    struct Type
    {
        const std::string *Name = nullptr;
        bool IsKnown = false;
    };
    std::vector<Type> _types;
};

}  // namespace Rabit
