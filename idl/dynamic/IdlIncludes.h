// One text of an IDL file, or of a .msg file of ROS 2, and all files that it includes, for the parser, which
// knows no preprocessor.
#pragma once

#include <string>
#include <vector>

namespace Rabit::Dynamic
{

// The text, with line markers (`#line 12 "uav.idl"`) from which the parser knows the places, and the paths of
// the IDL files. A file that is included again is left out. Throws Refused (ShapeBuilder.h), with file and line,
// for a file that cannot be read and for other directives than IdlFile.h names.
struct IncludedText
{
    std::string Text;
    std::vector<std::string> Paths;
};
IncludedText WithIncludes(const std::string &path, const std::vector<std::string> &folders);

}  // namespace Rabit::Dynamic
