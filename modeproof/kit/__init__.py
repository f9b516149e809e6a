"""The conformance kit: runs test vectors against a program behind an adapter. Standard library only.

Adapter protocol 1 is JSON Lines over standard input and output; one answer for each request, in order:

    > {"op":"hello","protocol":1,"target":"NAME"}
    < {"ok":true,"name":"my program","version":"1.2","time":"virtual","relations":["exact"],
       "max_latency_scans":0,"unobserved":[],"scans":true}
    > {"op":"reset","params":{"T_ms":1000}}              < {"ok":true}
    > {"op":"scan","dt_ms":10,"in":{..all inputs..}}         < {"out":{..all outputs..}}
    > {"op":"scans","list":[{"dt_ms":10,"in":{..}},..]}      < {"list":[{"out":{..}},..]}
    > {"op":"bye"}                                           < {"ok":true}

docs/adapter-protocol.md says what each field means and what must be refused. Standard error is free.

What cannot be judged (no answer in time, an answer that is not one JSON object, a second answer, a wrong
type, a missing or extra output, an adapter that ends) is UNJUDGED, names vector and scan, and ends the
adapter.
"""
