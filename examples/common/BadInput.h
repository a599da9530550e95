#pragma once

#include <stdexcept>

namespace Common
{

// An option or a file that a person gave is wrong. what() is one line for that person.
class BadInput : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

}  // namespace Common
