" Colours for scenarios in PuRSUE-ML.
if exists('b:current_syntax')
  finish
endif

syntax case match
syntax iskeyword @,48-57,_

syntax keyword pursueStatement agent assume battery connect door event for group lift mission objective optional poi
syntax keyword pursueStatement reach_objective rest rule state stateDependency thing travel unit
syntax keyword pursueConstant false is_false is_true true
syntax keyword pursueKeyword after agents all always and answered any apart at at_least at_most avoid before between by
syntax keyword pursueKeyword can_do capacity carries charges collaborative comes controllable distance do does doing
syntax keyword pursueKeyword duration each ends escort every except false_if from gives has holds hour human if in
syntax keyword pursueKeyword inflation initially is label lasts leaves location may_stop metre minute mobile mounts
syntax keyword pursueKeyword needs never never_with no none not of on_order on_way one_way only_if open opens or order
syntax keyword pursueKeyword parts patrol per place radius reaches reacts_to recharges robot robots second seen_at
syntax keyword pursueKeyword shown_by speed stays takes then through times to together tolerance true_if twice two
syntax keyword pursueKeyword unknown uses waits way when within
syntax match pursueNumber "\<[+-]\?\d[[:alnum:]_.]*\%([ \t]\+\%(s\|min\|h\|c\?m\)\>\%([ \t]\+\d[0-9.]*[ \t]\+\%(s\|min\|h\|c\?m\)\>\)*\)\?"
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
