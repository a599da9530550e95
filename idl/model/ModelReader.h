// Turns idlc's syntax tree into a Model, and refuses what the generator does not support.
#pragma once

#include "model/IdlTree.h"
#include "model/Model.h"
#include "model/Refusals.h"
#include "model/SourceComments.h"

#include <map>
#include <set>
#include <utility>

namespace RabitIdl
{

class ModelReader
{
public:
    // state: idlc's const idl_pstate_t *. The model names files below `base` by their relative path, all
    // others without a path.
    ModelReader(const void *state, Refusals &refusals, std::string base = "")
        : _state(state), _refusals(refusals), _base(std::move(base))
    {
    }
    // Returns the model, which is usable only if nothing was refused.
    Model Read();

private:
    void ReadFiles();
    std::string NameOf(TreeNode source) const;
    void ReadDefinitions(TreeNode first);
    void ReadStruct(TreeNode node);
    void ReadUnion(TreeNode node);
    void ReadEnum(TreeNode node);
    void ReadBitmask(TreeNode node);
    void ReadTypedef(TreeNode node);
    void ReadConst(TreeNode node);
    void ReadMembers(TreeNode structure, StructDefinition &definition);
    Type ReadType(TreeNode spec, TreeNode place);
    Type ReadDeclaredType(TreeNode spec, TreeNode declarator);
    Literal ReadLiteral(TreeNode value);

    void CheckName(TreeNode node, const std::string &name);
    // For modules and all that stands in them.
    void CheckNameInScope(TreeNode node, const std::string &name);
    void CheckTypeName(TreeNode node, const std::string &name);
    void CheckMemberNames(TreeNode node, const StructDefinition &definition);
    void CheckAnnotations(TreeNode node);
    void CheckIds(const StructDefinition &definition);
    bool IsAppendable(TreeNode node);
    void CheckKey(TreeNode place, const Type &type);
    void CheckKey(TreeNode place, const Type &type, std::set<const Definition *> &seen);
    void CheckKeyInComment(TreeNode place, const Member &member);
    void CheckDefault(TreeNode place, const Member &member);

    // The comments in the file on a node; nothing for included files.
    std::vector<std::string> CommentOn(TreeNode node);
    // The same for a part of a definition. Nothing if the definition begins in the same line: then the
    // comment is about the whole.
    std::vector<std::string> CommentOnPart(TreeNode node, const Definition &whole);
    void Refuse(TreeNode place, const std::string &message);
    template <class T>
    std::unique_ptr<T> Begin(TreeNode node);
    void Finish(TreeNode node, std::unique_ptr<Definition> definition);

    const void *_state;
    Refusals &_refusals;
    const std::string _base;
    Model _model;
    std::vector<std::string> _scope;
    std::map<std::string, SourceComments> _comments;                                  // by file
    std::map<TreeNode, const Definition *> _known;                                    // by type node
    std::map<TreeNode, std::pair<const EnumDefinition *, std::size_t>> _enumerators;  // by enumerator node
};

}  // namespace RabitIdl
