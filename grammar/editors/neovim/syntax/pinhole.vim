" Highlights scenes if the language server does not. The words before a name decide whether it is a field or a value.

if exists("b:current_syntax")
  finish
endif

syn cluster pinholeValue contains=pinholeSign,pinholeNumber,pinholeCode,pinholeName,pinholeCall,pinholeGroup

syn keyword pinholeKeyword let skipwhite skipempty nextgroup=pinholeDefined
syn match pinholeDefined /\<\h\w*\>/ contained skipwhite skipempty nextgroup=pinholeEquals
syn match pinholeEquals /=/ contained skipwhite skipempty nextgroup=@pinholeValue

syn match pinholeKind /\<\%(let\>\)\@!\h\w*\>/ skipwhite skipempty nextgroup=pinholeObject,pinholeHead,pinholeBody
syn match pinholeObject /\<\h\w*\>/ contained skipwhite skipempty nextgroup=pinholeHead,pinholeBody
syn region pinholeHead matchgroup=pinholeKeyword start=/\<for\>/ end=/\ze[{}]/ contained contains=pinholeIndex,@pinholeValue,pinholeComment skipwhite skipempty nextgroup=pinholeBody
syn region pinholeBody start=/{/ end=/}/ contained contains=pinholeField,pinholeMethodField,pinholeComment

syn match pinholeField /\<\h\w*\>/ contained skipwhite skipempty nextgroup=@pinholeValue
syn match pinholeMethodField /\<method\>/ contained skipwhite skipempty nextgroup=pinholeMethod
syn match pinholeMethod /\<\h\w*\>/ contained

syn match pinholeSign /-/ contained skipwhite skipempty nextgroup=@pinholeValue
syn match pinholeOperator "[-+*]\|/\ze[^/*]" contained skipwhite skipempty nextgroup=@pinholeValue
syn match pinholeNumber /\<\d[0-9_]*\%(\.[0-9_]*\)\?\%([eE][-+]\?\d[0-9_]*\)\?\%(deg\|rad\)\?/ contained skipwhite skipempty nextgroup=pinholeOperator
syn match pinholeNumber /\.\d[0-9_]*\%([eE][-+]\?\d[0-9_]*\)\?\%(deg\|rad\)\?/ contained skipwhite skipempty nextgroup=pinholeOperator
syn match pinholeCode /#\x\+/ contained skipwhite skipempty nextgroup=pinholeOperator
syn match pinholeName /\<\h\w*\>/ contained skipwhite skipempty nextgroup=pinholeOperator
syn match pinholeIndex /\<\h\w*\>\ze\_s*</ contained skipwhite skipempty nextgroup=pinholeLess
syn match pinholeLess /</ contained skipwhite skipempty nextgroup=@pinholeValue
syn match pinholeCall /\<\h\w*\>\ze\_s*(/ contained skipwhite skipempty nextgroup=pinholeGroup
syn region pinholeGroup start=/(/ end=/)/ contained contains=@pinholeValue,pinholeComment skipwhite skipempty nextgroup=pinholeOperator

syn match pinholeComment "//.*$" contains=@Spell
syn region pinholeComment start="/\*" end="\*/" contains=@Spell

syn sync minlines=100

hi def link pinholeKeyword Keyword
hi def link pinholeKind Keyword
hi def link pinholeDefined Identifier
hi def link pinholeObject Type
hi def link pinholeIndex Identifier
hi def link pinholeLess Operator
hi def link pinholeField Identifier
hi def link pinholeMethodField Identifier
hi def link pinholeMethod Constant
hi def link pinholeEquals Operator
hi def link pinholeSign Operator
hi def link pinholeOperator Operator
hi def link pinholeNumber Number
hi def link pinholeCode Constant
hi def link pinholeName NONE
hi def link pinholeCall Function
hi def link pinholeComment Comment

let b:current_syntax = "pinhole"
