// The rules by which ModelReader refuses definitions that parse but have no faithful C++ class or no plain
// XCDR1 encoding.
#include "model/LibraryNames.h"
#include "model/ModelReader.h"
#include "model/Names.h"

#include <algorithm>

namespace RabitIdl
{

void ModelReader::CheckName(TreeNode node, const std::string &name)
{
    const std::string reason = WhyNotCpp(name);
    if (!reason.empty())
    {
        Refuse(node, "'" + name + "' " + reason);
    }
}

void ModelReader::CheckNameInScope(TreeNode node, const std::string &name)
{
    CheckName(node, name);
    if (IsGeneratorName(name))
    {
        Refuse(node, "'" + name + "' is the name of a function that is generated beside the types");
    }
    if (_scope.empty() && IsLibraryName(name))
    {
        Refuse(node, "'" + name + "' is a name of the C library; put it into a module of another name");
    }
}

void ModelReader::CheckTypeName(TreeNode node, const std::string &name)
{
    CheckNameInScope(node, name);
    const bool inRabit = (_scope.size() == 1 && _scope[0] == "Rabit") ||
                         (_scope.size() >= 2 && _scope[0] == "Rabit" && _scope[1] == "Idl");
    if (inRabit)
    {
        Refuse(node, "'" + ScopedName(_scope, name) +
                         "' is in a namespace of the Rabit library; use another module");
    }
}

void ModelReader::CheckMemberNames(TreeNode node, const StructDefinition &definition)
{
    for (const Member *member : AllMembers(definition))
    {
        if (member->Name == definition.Name)
        {
            _refusals.Add(member->File, member->Line,
                          "member '" + member->Name + "' has the name of its struct");
        }
        if (IsMessage(definition) && IsMessageMember(member->Name))
        {
            _refusals.Add(member->File, member->Line,
                          "member '" + member->Name + "' has the name of a member of every Rabit message");
        }
    }
    if (IsMessage(definition) && IsMessageMember(definition.Name))
    {
        Refuse(node, "'" + definition.Name + "' is the name of a member of every Rabit message");
    }
}

void ModelReader::CheckAnnotations(TreeNode node)
{
    static const std::set<std::string> refused{"external", "max",   "min",          "must_understand",
                                               "optional", "range", "try_construct"};
    // `mutable` on structs and unions is left to IsAppendable, which sees the final extensibility, defaults
    // included.
    const TreeKind kind = TreeKindOf(node);
    const bool isAggregate = kind == TreeStruct || kind == TreeUnion;
    for (TreeNode item = TreeAnnotations(node); item != nullptr; item = TreeNext(item))
    {
        const std::string name = TreeAnnotationName(item);
        if (refused.count(name) != 0 || (!isAggregate && name == "mutable"))
        {
            Refuse(item, "annotation @" + name + " is not supported");
        }
    }
}

namespace
{

// The first member whose id is below that of an earlier one, or null.
const Member *FirstOutOfOrder(const std::vector<const Member *> &members)
{
    for (std::size_t i = 1; i < members.size(); ++i)
    {
        if (members[i]->Id < members[i - 1]->Id)
        {
            return members[i];
        }
    }
    return nullptr;
}

}  // namespace

// The order of the keys in a key hash goes by member id (OMG DDS-XTypes 1.3, 7.6.8); the generator keeps
// the order of declaration.
void ModelReader::CheckIds(const StructDefinition &definition)
{
    const Member *member = HasKey(definition) ? FirstOutOfOrder(KeyMembers(definition)) : nullptr;
    if (member != nullptr)
    {
        _refusals.Add(member->File, member->Line,
                      "the id of key '" + member->Name +
                          "' is below that of a key before it; declare keys in the order of their ids");
    }
}

bool ModelReader::IsAppendable(TreeNode node)
{
    const std::string name = TreeName(node);
    if (TreeExtensibilityOf(node) == TreeMutable)
    {
        Refuse(node, "'" + name + "' is @mutable; only @final and @appendable types are supported");
    }
    if (!TreeAllowsXcdr1(node))
    {
        Refuse(node, "'" + name + "' excludes the data representation XCDR1, the only one supported");
    }
    return TreeExtensibilityOf(node) == TreeAppendable;
}

void ModelReader::CheckKey(TreeNode place, const Type &type)
{
    std::set<const Definition *> seen;
    CheckKey(place, type, seen);
}

// Each struct is visited once: nested repetition could otherwise take exponential time.
void ModelReader::CheckKey(TreeNode place, const Type &type, std::set<const Definition *> &seen)
{
    const Type &real = Unalias(type);
    switch (real.What)
    {
        case Type::Kind::Primitive:
        case Type::Kind::String:
            return;
        case Type::Kind::Array:
            CheckKey(place, *real.Element, seen);
            return;
        case Type::Kind::Sequence:
            Refuse(place, "a key that is or contains a sequence is not supported");
            return;
        case Type::Kind::Named:
            break;
    }
    if (!seen.insert(real.Named).second)
    {
        return;
    }
    if (dynamic_cast<const UnionDefinition *>(real.Named) != nullptr)
    {
        Refuse(place, "a key that is or contains a union is not supported");
    }
    if (const auto *structure = dynamic_cast<const StructDefinition *>(real.Named))
    {
        const std::vector<const Member *> members = KeyMembers(*structure);
        if (!HasKey(*structure) && FirstOutOfOrder(members) != nullptr)
        {
            Refuse(place, "a key of type '" + structure->Name + "' is not supported: the id of its member '" +
                              FirstOutOfOrder(members)->Name + "' is below that of one before it");
        }
        for (const Member *member : members)
        {
            CheckKey(place, member->Type, seen);
        }
    }
}

// Some compilers read keys from comments. Without its key, a topic would silently match no other program.
void ModelReader::CheckKeyInComment(TreeNode place, const Member &member)
{
    const bool isKey = std::any_of(member.Comment.begin(), member.Comment.end(),
                                   [](const std::string &line) { return line == "@key"; });
    if (isKey && !member.Key)
    {
        Refuse(place, "'" + member.Name +
                          "' is a key by a comment alone, which is not supported; write @key before it");
    }
}

void ModelReader::CheckDefault(TreeNode place, const Member &member)
{
    const Type &type = Unalias(member.Type);
    if (type.What != Type::Kind::Primitive && type.What != Type::Kind::String)
    {
        Refuse(place,
               "@default on '" + member.Name + "' is not supported, its type is not a primitive or a string");
        return;
    }
    const auto *text = std::get_if<std::string>(member.Default.get());
    if ((type.What == Type::Kind::String) != (text != nullptr))
    {
        Refuse(place, "the @default of '" + member.Name + "' is not of its type");
    }
    else if (text != nullptr && type.Bound != 0 && text->size() > type.Bound)
    {
        Refuse(place, "the @default of '" + member.Name + "' is longer than its bound");
    }
}

}  // namespace RabitIdl
