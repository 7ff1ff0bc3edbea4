" krs.vim: syntax colouring of krs scenes for Vim.
"
" Put it into ~/.vim/syntax/ and `autocmd BufNewFile,BufRead *.krs setfiletype krs` into your
" vimrc.  The words are those of compiler/front/token.def; tests/editors.sh compares them.

if exists("b:current_syntax")
    finish
endif

syntax keyword krsStatement let def param shape material camera light sky fog medium image zone show use krs
syntax keyword krsControl for if then else in
syntax keyword krsOperatorWord and or not
syntax keyword krsConstant true false

" Words that begin a statement only within `krs { ... }`.
syntax match krsStage "\v(^|[{};])\s*\zs(kernel|reflect|mobius)>"
" These are names, too, unless a parenthesis follows.
syntax match krsStage "\v<(print|assert)>\ze\("
" Names of properties and arguments, and methods, whatever word they are.
syntax match krsLabel "\v<\h\w*\ze\s*:"
syntax match krsMethod "\v\.\s*\zs\h\w*"

syntax match krsNumber "\v<\d+(\.\d+)?(e[-+]?\d+)?(deg)?>"
syntax match krsColour "#\x\{6}\>"
syntax match krsOperator "==\|!=\|<=\|>=\|\.\.\|[-+*/%^&|=<>]"
syntax region krsString start=+"+ skip=+\\.+ end=+"+ oneline
syntax match krsComment "//.*$" contains=@Spell
syntax match krsDoc "///\(/\)\@!.*$" contains=@Spell
syntax region krsComment start="/\*" end="\*/" contains=@Spell

highlight default link krsStatement Statement
highlight default link krsControl Conditional
highlight default link krsOperatorWord Operator
highlight default link krsConstant Boolean
highlight default link krsStage Statement
highlight default link krsLabel Identifier
highlight default link krsMethod Function
highlight default link krsNumber Number
highlight default link krsColour Constant
highlight default link krsOperator Operator
highlight default link krsString String
highlight default link krsComment Comment
highlight default link krsDoc SpecialComment

let b:current_syntax = "krs"
