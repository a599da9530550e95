#pragma once

#include <stdexcept>

namespace Rabit::Keys
{

// Keys that cannot be made, read or used. what() is one line for people: the problem, with the file, and the
// remedy.
class KeysError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

}  // namespace Rabit::Keys
