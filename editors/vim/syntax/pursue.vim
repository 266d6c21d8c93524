" Colours for scenarios in PuRSUE-ML.
if exists('b:current_syntax')
  finish
endif

syntax case match
syntax iskeyword @,48-57,_

syntax keyword pursueStatement agent assume battery connect event objective optional poi reach_objective rule state stateDependency travel
syntax keyword pursueConstant false is_false is_true true
syntax keyword pursueKeyword after and at at_most avoid before between can_do collaborative controllable distance do does
syntax keyword pursueKeyword duration false_if from human if initially leaves location mobile never never_with one_way
syntax keyword pursueKeyword only_if or reacts_to takes then times to together true_if waits within
syntax keyword pursueKeyword always any by capacity every in label order patrol doing no not on_way per radius recharges
syntax keyword pursueKeyword robot each for unit uses tolerance inflation
syntax match pursueNumber "\<[+-]\?\d[[:alnum:]_.]*"
syntax match pursueName +"[^"]*"+
syntax match pursueTail "control[ \t]*:.*"
syntax keyword pursueTodo TODO FIXME contained
syntax match pursueComment "//.*" contains=pursueTodo
syntax match pursuePose "//[ \t]*\(\h\w*[ \t]*\)\?\[.*"
syntax region pursueComment start="/\*" end="\*/" contains=pursueTodo

highlight default link pursueStatement Statement
highlight default link pursueConstant Constant
highlight default link pursueKeyword Keyword
highlight default link pursueNumber Number
highlight default link pursueName String
highlight default link pursueTail PreProc
highlight default link pursueTodo Todo
highlight default link pursueComment Comment
highlight default link pursuePose SpecialComment

let b:current_syntax = 'pursue'
