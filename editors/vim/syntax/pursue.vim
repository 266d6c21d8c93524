" Colours for scenarios in PuRSUE-ML.
if exists('b:current_syntax')
  finish
endif

syntax case match
syntax iskeyword @,48-57,_

syntax keyword pursueStatement agent assume battery connect event for group objective optional poi reach_objective rule
syntax keyword pursueStatement state stateDependency travel
syntax keyword pursueConstant false is_false is_true true
syntax keyword pursueKeyword after agents all always and any apart at at_least at_most avoid before between by can_do
syntax keyword pursueKeyword capacity collaborative controllable distance do does doing duration each escort every
syntax keyword pursueKeyword except false_if from holds human if in inflation initially label leaves location mobile
syntax keyword pursueKeyword never never_with no none not of on_way one_way only_if or order patrol per place radius
syntax keyword pursueKeyword reacts_to recharges robot robots stays takes then times to together tolerance true_if twice
syntax keyword pursueKeyword two unit uses waits way within
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
