// Reads `.msg` files of ROS 2.
#pragma once

#include "model/Refusals.h"
#include "ros/MsgFile.h"

#include <string>
#include <utility>
#include <vector>

namespace RabitIdl
{

class MsgReader
{
public:
    // `path` is used in refusals.
    MsgReader(std::string path, Refusals &refusals) : _path(std::move(path)), _refusals(refusals) {}
    // The result is usable only if nothing was refused.
    MsgFile Read(const std::string &text, const std::string &package, const std::string &name);

private:
    void ReadLine(std::string line);
    void ReadEntry(const std::string &line);
    void TakeComment(const std::string &text);
    void TakeRemark(const std::string &text);
    void CheckName(const MsgEntry &entry, bool isConstant);
    MsgType ReadType(const std::string &text);
    MsgType ReadElement(const std::string &text);
    std::string ReadValue(const MsgType &type, const std::string &text);
    std::string ReadInteger(const MsgType &type, const std::string &text);
    std::string ReadFloat(const MsgType &type, const std::string &text);
    std::string ReadString(const MsgType &type, std::string text);
    void Refuse(const std::string &message);

    const std::string _path;
    Refusals &_refusals;
    MsgFile _file;
    std::uint32_t _line = 0;
    std::vector<std::string> _comment;
    MsgEntry *_last = nullptr;  // the entry that a remark behind it or below it describes
};

}  // namespace RabitIdl
