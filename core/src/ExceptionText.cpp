#include "ExceptionText.h"

#include <exception>

namespace Rabit
{

std::string CurrentExceptionText()
{
    try
    {
        throw;
    }
    catch (const std::exception &exception)
    {
        return exception.what();
    }
    catch (const std::string &text)
    {
        return text;
    }
    catch (const char *text)
    {
        return text != nullptr ? text : "a null string";
    }
    catch (...)
    {
        return "an object that is no std::exception";
    }
}

}  // namespace Rabit
