#pragma once

#include <exception>
#include <iostream>
#include <sstream>
#include <string>

namespace Rabit
{

// Thrown when a message or queue is asked for by a name that is not registered.
class MessageNotRegisteredException : public std::exception
{
public:
    MessageNotRegisteredException();
    explicit MessageNotRegisteredException(std::string text);
    const char *what() const noexcept override;

private:
    std::string _text;
};

}  // namespace Rabit
