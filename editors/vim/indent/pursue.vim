" Indentation of scenarios in PuRSUE-ML: a statement begins at the margin, what goes on of it stands further in.
if exists('b:did_indent')
  finish
endif
let b:did_indent = 1

setlocal indentexpr=PursueIndent()
setlocal indentkeys=o,O,<Space>,:
let b:undo_indent = 'setlocal indentexpr< indentkeys<'

if exists('*PursueIndent')
  finish
endif

let s:statement = split('
      \ agent assume battery connect door event for group lift mission objective optional poi reach_objective rest
      \ rule state stateDependency thing travel unit')
let s:goes_on = split('
      \ after agents all always and answered any apart at at_least at_most avoid before between by can_do capacity
      \ carries charges collaborative comes controllable distance do does doing duration each ends escort every except
      \ false false_if from gives has holds hour human if in inflation initially is is_false is_true label lasts
      \ leaves location may_stop metre minute mobile mounts needs never never_with no none not of on_order on_way
      \ one_way only_if open opens or order parts patrol per place radius reaches reacts_to recharges robot robots
      \ second seen_at shown_by speed stays takes then through times to together tolerance true true_if twice two
      \ unknown uses waits way when within')

function! s:Begins(line, words) abort
  return index(a:words, matchstr(a:line, '^\s*\zs\w\+\ze\%(\s*,\)\@!')) >= 0
endfunction

function! PursueIndent() abort
  let line = getline(v:lnum)
  if synIDattr(synID(v:lnum, indent(v:lnum) + 1, 0), 'name') ==# 'pursueComment'
    return -1
  endif
  if s:Begins(line, s:goes_on)
    return shiftwidth()
  endif
  let before = substitute(getline(prevnonblank(v:lnum - 1)), '//.*', '', '')
  if !s:Begins(line, s:statement) && before =~# ',\s*$'
    return shiftwidth()
  endif
  return 0
endfunction
