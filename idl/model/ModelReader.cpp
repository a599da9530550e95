#include "model/ModelReader.h"

#include "model/Names.h"
#include "model/SourceScan.h"

#include <algorithm>
#include <functional>

namespace RabitIdl
{
namespace
{

std::string WithoutDirectories(const std::string &path)
{
    return path.substr(path.find_last_of("/\\") + 1);
}

const std::map<TreeKind, Primitive> &Primitives()
{
    static const std::map<TreeKind, Primitive> table{
        {TreeBool, Primitive::Bool},     {TreeChar, Primitive::Char},     {TreeOctet, Primitive::Octet},
        {TreeInt8, Primitive::Int8},     {TreeUint8, Primitive::Uint8},   {TreeInt16, Primitive::Int16},
        {TreeUint16, Primitive::Uint16}, {TreeInt32, Primitive::Int32},   {TreeUint32, Primitive::Uint32},
        {TreeInt64, Primitive::Int64},   {TreeUint64, Primitive::Uint64}, {TreeFloat, Primitive::Float},
        {TreeDouble, Primitive::Double}};
    return table;
}

}  // namespace

Model ModelReader::Read()
{
    ReadFiles();
    RefuseWhatIdlcMisreads(_model.AllPaths, _refusals);
    ReadDefinitions(TreeRoot(_state));
    return std::move(_model);
}

std::string ModelReader::NameOf(TreeNode source) const
{
    const std::string path = TreeSourcePath(source);
    const std::string folder = _base + "/";
    return !_base.empty() && path.compare(0, folder.size(), folder) == 0 ? path.substr(folder.size())
                                                                         : WithoutDirectories(path);
}

void ModelReader::ReadFiles()
{
    const TreeNode main = TreeFirstSource(_state);
    if (main == nullptr)
    {
        return;  // a text that is in no file
    }
    _model.MainFile = NameOf(main);
    for (TreeNode include = TreeIncludes(main); include != nullptr; include = TreeNextSource(include))
    {
        const std::string name = NameOf(include);
        if (std::find(_model.Includes.begin(), _model.Includes.end(), name) == _model.Includes.end())
        {
            _model.Includes.push_back(name);
        }
    }
    const std::function<void(TreeNode)> visit = [&](TreeNode source)
    {
        for (; source != nullptr; source = TreeNextSource(source))
        {
            const std::string path = TreeSourcePath(source);
            if (std::find(_model.AllPaths.begin(), _model.AllPaths.end(), path) == _model.AllPaths.end())
            {
                _model.AllPaths.push_back(path);
            }
            visit(TreeIncludes(source));
        }
    };
    visit(main);
}

void ModelReader::ReadDefinitions(TreeNode first)
{
    for (TreeNode node = first; node != nullptr; node = TreeNext(node))
    {
        switch (TreeKindOf(node))
        {
            case TreeModule:
                CheckNameInScope(node, TreeName(node));
                if (_scope.empty() && std::string(TreeName(node)) == "std")
                {
                    Refuse(node, "'std' is the namespace of the C++ standard library");
                }
                _scope.push_back(TreeName(node));
                ReadDefinitions(TreeModuleContents(node));
                _scope.pop_back();
                break;
            case TreeStruct:
                ReadStruct(node);
                break;
            case TreeUnion:
                ReadUnion(node);
                break;
            case TreeEnum:
                ReadEnum(node);
                break;
            case TreeBitmask:
                ReadBitmask(node);
                break;
            case TreeTypedef:
                ReadTypedef(node);
                break;
            case TreeConst:
                ReadConst(node);
                break;
            case TreeForward:
            case TreeAnnotation:
                break;
            default:
                Refuse(node, std::string(TreeConstruct(node)) + " is not supported");
        }
    }
}

void ModelReader::Refuse(TreeNode place, const std::string &message)
{
    _refusals.Add(TreeFileOf(place), TreeLineOf(place), message);
}

std::vector<std::string> ModelReader::CommentOn(TreeNode node)
{
    if (TreeFirstSource(_state) == nullptr || !TreeInMainFile(_state, node))
    {
        return {};
    }
    const std::string file = TreeFileOf(node);
    const auto found = _comments.try_emplace(file, file).first;
    return found->second.About(TreeLineOf(node));
}

std::vector<std::string> ModelReader::CommentOnPart(TreeNode node, const Definition &whole)
{
    return TreeLineOf(node) == whole.Line ? std::vector<std::string>() : CommentOn(node);
}

template <class T>
std::unique_ptr<T> ModelReader::Begin(TreeNode node)
{
    auto definition = std::make_unique<T>();
    definition->Scope = _scope;
    definition->Name = TreeName(node);
    definition->File = TreeFileOf(node);
    definition->Line = TreeLineOf(node);
    definition->InMainFile = TreeInMainFile(_state, node);
    definition->Comment = CommentOn(node);
    if (!std::is_same_v<T, TypedefDefinition> || !IsTypedefOfRos(definition->Name))
    {
        CheckTypeName(node, definition->Name);
    }
    CheckAnnotations(node);
    return definition;
}

void ModelReader::Finish(TreeNode node, std::unique_ptr<Definition> definition)
{
    _known[node] = definition.get();
    _model.Definitions.push_back(std::move(definition));
}

void ModelReader::ReadStruct(TreeNode node)
{
    auto definition = Begin<StructDefinition>(node);
    definition->Nested = TreeIsNested(node);
    definition->Appendable = IsAppendable(node);
    if (TreeHasKeylist(node))
    {
        Refuse(node, "#pragma keylist is not supported, mark the members with @key");
    }
    if (const TreeNode base = TreeBase(node))
    {
        const auto found = _known.find(base);
        definition->Base =
            found == _known.end() ? nullptr : dynamic_cast<const StructDefinition *>(found->second);
        if (definition->Base == nullptr)
        {
            Refuse(node, "the base of '" + definition->Name + "' is not a struct defined before it");
        }
        else if (definition->Nested && IsMessage(*definition->Base))
        {
            Refuse(node, "'" + definition->Name + "' is @nested but its base '" + definition->Base->Name +
                             "' is a message; mark both @nested, or none");
        }
    }
    ReadMembers(node, *definition);
    if (AllMembers(*definition).empty())
    {
        Refuse(node, "'" + definition->Name + "' has no members");
    }
    CheckMemberNames(node, *definition);
    CheckIds(*definition);
    Finish(node, std::move(definition));
}

void ModelReader::ReadMembers(TreeNode structure, StructDefinition &definition)
{
    for (TreeNode node = TreeMembers(structure); node != nullptr; node = TreeNext(node))
    {
        CheckAnnotations(node);
        for (TreeNode declarator = TreeDeclarators(node); declarator != nullptr;
             declarator = TreeNext(declarator))
        {
            Member member;
            member.Name = TreeName(declarator);
            member.File = TreeFileOf(declarator);
            member.Line = TreeLineOf(declarator);
            CheckName(declarator, member.Name);
            member.Type = ReadDeclaredType(TreeTypeSpec(node), declarator);
            member.Key = TreeIsKey(node);
            member.Id = TreeMemberId(declarator);
            member.Comment = CommentOnPart(declarator, definition);
            CheckKeyInComment(declarator, member);
            member.Unit = TreeUnit(node) != nullptr ? TreeUnit(node) : "";
            if (member.Key)
            {
                CheckKey(declarator, member.Type);
            }
            if (const TreeNode value = TreeDefault(node))
            {
                member.Default = std::make_unique<Literal>(ReadLiteral(value));
                CheckDefault(declarator, member);
            }
            definition.Members.push_back(std::move(member));
        }
    }
}

void ModelReader::ReadUnion(TreeNode node)
{
    auto definition = Begin<UnionDefinition>(node);
    definition->Appendable = IsAppendable(node);
    const TreeNode selector = TreeSwitch(node);
    CheckAnnotations(selector);
    if (TreeSwitchIsKey(selector))
    {
        Refuse(selector, "@key on the discriminator of a union is not supported");
    }
    definition->Discriminator = ReadType(TreeSwitchType(selector), selector);
    for (TreeNode item = TreeCases(node); item != nullptr; item = TreeNext(item))
    {
        CheckAnnotations(item);
        const TreeNode declarator = TreeCaseDeclarator(item);
        Case entry;
        entry.Content.Name = TreeName(declarator);
        entry.Content.File = TreeFileOf(declarator);
        entry.Content.Line = TreeLineOf(declarator);
        entry.Content.Comment = CommentOnPart(declarator, *definition);
        CheckName(declarator, entry.Content.Name);
        entry.Content.Type = ReadDeclaredType(TreeTypeSpec(item), declarator);
        for (TreeNode label = TreeLabels(item); label != nullptr; label = TreeNext(label))
        {
            if (TreeIsDefaultLabel(label))
            {
                entry.Default = true;
                definition->HasDefaultCase = true;
            }
            else
            {
                entry.Labels.push_back(TreeLabelValue(label));
            }
        }
        definition->Cases.push_back(std::move(entry));
    }
    definition->HasUnusedValue = !definition->HasDefaultCase && TreeUnusedLabels(node) > 0;
    if (TreeHasDefaultValue(node))
    {
        definition->UnusedValue = TreeDefaultValue(node);
    }
    Finish(node, std::move(definition));
}

void ModelReader::ReadEnum(TreeNode node)
{
    auto definition = Begin<EnumDefinition>(node);
    definition->BitBound = TreeEnumBitBound(node);
    for (TreeNode item = TreeEnumerators(node); item != nullptr; item = TreeNext(item))
    {
        CheckName(item, TreeName(item));
        CheckAnnotations(item);
        if (item == TreeDefaultEnumerator(node))
        {
            definition->Default = definition->Enumerators.size();
        }
        _enumerators[item] = {definition.get(), definition->Enumerators.size()};
        definition->Enumerators.push_back(
            {TreeName(item), TreeEnumeratorValue(item), CommentOnPart(item, *definition)});
    }
    Finish(node, std::move(definition));
}

void ModelReader::ReadBitmask(TreeNode node)
{
    auto definition = Begin<BitmaskDefinition>(node);
    definition->BitBound = TreeBitmaskBitBound(node);
    for (TreeNode item = TreeBits(node); item != nullptr; item = TreeNext(item))
    {
        CheckName(item, TreeName(item));
        CheckAnnotations(item);
        definition->Bits.push_back({TreeName(item), TreeBitPosition(item), CommentOnPart(item, *definition)});
    }
    Finish(node, std::move(definition));
}

void ModelReader::ReadTypedef(TreeNode node)
{
    CheckAnnotations(node);
    for (TreeNode declarator = TreeDeclarators(node); declarator != nullptr;
         declarator = TreeNext(declarator))
    {
        auto definition = Begin<TypedefDefinition>(declarator);
        definition->InIdlOnly = IsTypedefOfRos(definition->Name);
        definition->Type = ReadDeclaredType(TreeTypeSpec(node), declarator);
        Finish(declarator, std::move(definition));
    }
}

void ModelReader::ReadConst(TreeNode node)
{
    auto definition = Begin<ConstDefinition>(node);
    definition->Type = ReadType(TreeConstType(node), node);
    definition->Value = ReadLiteral(TreeConstValue(node));
    Finish(node, std::move(definition));
}

Type ModelReader::ReadType(TreeNode spec, TreeNode place)
{
    Type type;
    const TreeKind kind = TreeKindOf(spec);
    const auto primitive = Primitives().find(kind);
    if (primitive != Primitives().end())
    {
        type.Scalar = primitive->second;
        return type;
    }
    switch (kind)
    {
        case TreeString:
            type.What = Type::Kind::String;
            type.Bound = TreeBound(spec);
            return type;
        case TreeSequence:
            type.What = Type::Kind::Sequence;
            type.Bound = TreeBound(spec);
            type.Element = std::make_shared<Type>(ReadType(TreeTypeSpec(spec), place));
            return type;
        case TreeAlias:
        case TreeStruct:
        case TreeUnion:
        case TreeEnum:
        case TreeBitmask:
        case TreeForward:
        {
            const auto found = _known.find(spec);
            if (found == _known.end())
            {
                Refuse(place,
                       "'" + std::string(TreeName(spec)) +
                           "' is used before its definition is complete (recursive types are not supported)");
                return type;
            }
            type.What = Type::Kind::Named;
            type.Named = found->second;
            return type;
        }
        case TreeWideChar:
            Refuse(place, "type wchar is not supported");
            return type;
        case TreeWideString:
            Refuse(place, "type wstring is not supported");
            return type;
        case TreeLongDouble:
            Refuse(place, "type long double is not supported");
            return type;
        default:
            Refuse(place, "type " + std::string(TreeConstruct(spec)) + " is not supported");
            return type;
    }
}

Type ModelReader::ReadDeclaredType(TreeNode spec, TreeNode declarator)
{
    std::vector<std::uint32_t> dimensions;
    for (TreeNode item = TreeDimensions(declarator); item != nullptr; item = TreeNext(item))
    {
        dimensions.push_back(TreeDimension(item));
    }
    Type type = ReadType(spec, declarator);
    for (auto length = dimensions.rbegin(); length != dimensions.rend(); ++length)
    {
        Type array;
        array.What = Type::Kind::Array;
        array.Length = *length;
        array.Element = std::make_shared<Type>(std::move(type));
        type = std::move(array);
    }
    return type;
}

Literal ModelReader::ReadLiteral(TreeNode value)
{
    if (TreeIsEnumerator(value))
    {
        const auto &[definition, index] = _enumerators.at(value);
        return EnumeratorValue{definition, index};
    }
    switch (TreeLiteralKind(value))
    {
        case TreeBool:
            return TreeLiteralUnsigned(value) != 0;
        case TreeChar:
            return static_cast<char>(TreeLiteralSigned(value));
        case TreeOctet:
        case TreeUint8:
        case TreeUint16:
        case TreeUint32:
        case TreeUint64:
            return TreeLiteralUnsigned(value);
        case TreeInt8:
        case TreeInt16:
        case TreeInt32:
        case TreeInt64:
            return TreeLiteralSigned(value);
        case TreeFloat:
        case TreeDouble:
            return TreeLiteralDouble(value);
        case TreeString:
            return std::string(TreeLiteralString(value));
        default:
            Refuse(value, "a value of this type is not supported");
            return false;
    }
}

}  // namespace RabitIdl
