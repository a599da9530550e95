#pragma once

#include <rabit/dynamic/DynamicType.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

// The messages of an IDL file, or of a .msg file of ROS 2, for a program that loads them while it runs. The
// types have the IdlText that the generator gives those of the same file. So nodes with generated types and
// with these take each other's messages.
//
// The file is one of this computer that its user trusts: the parser is not made for hostile texts
// (idl/dynamic/README.md). It may include other files and have constants. Of the preprocessor it may use
// `#include`, `#pragma once`, and `#ifndef`, `#define` and `#endif` around a whole file.
//
// A file PACKAGE/msg/NAME.msg of ROS 2 is read as its message `PACKAGE::msg::NAME`.
struct IdlFile
{
    std::vector<std::shared_ptr<const DynamicType>> Messages;  // in their order, included files' first
    // The comments of the file, for people: on `Uav::Pose` and on `Uav::Pose.altitude_m`.
    std::map<std::string, std::string> Comments;
    // Constants by name, such as `Uav::MaxTargets`, and their values as in JSON.
    std::vector<std::pair<std::string, std::string>> Constants;
    // Why there is nothing: `file:line: reason`. Empty: the file is loaded.
    std::string Reason;

    // Included files are looked for beside the file that includes them, then in `folders`. Those of a file in
    // PACKAGE/msg are also looked for beside PACKAGE, and a .msg file has precedence over an .idl file.
    static IdlFile Load(const std::string &path, const std::vector<std::string> &folders = {});
};

}  // namespace Rabit
