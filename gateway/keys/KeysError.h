#pragma once

#include <stdexcept>

namespace Rabit::Keys
{

// Keys that cannot be made, read or used. what() is one line for people: what is wrong, with the file, and
// what to do.
class KeysError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

}  // namespace Rabit::Keys
