----------------------------- MODULE WrongWords -----------------------------
(***************************************************************************)
(* Words that come from two others: read a byte beside their place, or     *)
(* copied one byte at a time (EKS-SD-17, assumptions A-01 and A-10).       *)
(***************************************************************************)
EXTENDS CodeTables

Known(w) == IF w \in WordClasses THEN w ELSE OtherWord
\* The left byte of one word with the right byte of another
Mixed(left, right) == Known((left \div 256) * 256 + (right % 256))
\* A read that begins one byte too late: the right byte of one flag word, the left byte of the next
Straddled(one, next) == Known((one % 256) * 256 + (next \div 256))

\* A-01: a torn word is one of the two that it is torn from, or no code: never a third code
ASSUME \A a, b \in Codes \cup {0} : Mixed(a, b) \in {a, b, OtherWord}
=============================================================================
